// SPDX-License-Identifier: MIT
// A picture of a page of an atlas: every chart in a colour of its own.
#include "atlas/stages.h"

#include "base/random.h"

typedef struct painter {
    const alp_atlas *atlas;
    uint8_t *bytes; // [height][width][3]
} painter;

static alp_result paint_band(void *user, const alpi_band *band)
{
    const painter *p = user;
    for (uint32_t y = band->first_row; y < band->end_row; y++) {
        const uint32_t row = y - band->first_row;
        for (uint32_t x = band->columns[row][0]; x < band->columns[row][1]; x++) {
            const alpi_cell *cell = &band->cells[(size_t)row * band->width + x];
            if (cell->triangle == ALPI_NONE) {
                continue;
            }
            uint8_t *pixel = &p->bytes[3 * ((size_t)y * band->width + x)];
            uint32_t color = alpi_hash32(p->atlas->triangle_charts[cell->triangle] + 1);
            for (int k = 0; k < 3; k++) { // never near black
                pixel[k] = (uint8_t)(80 + ((color >> (8 * k)) & 255u) * 175 / 255);
            }
        }
    }
    return ALP_OK;
}

alp_result alp_atlas_picture(const alp_atlas *atlas, uint32_t page, alp_image **image)
{
    if (image == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *image = NULL;
    if (atlas == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (page >= atlas->info.pages) {
        return alpi_fail(atlas->context, ALP_ERROR_INVALID_ARGUMENT,
                         "page %u of an atlas of %u pages does not exist", page, atlas->info.pages);
    }
    alp_image_info info = {atlas->info.width, atlas->info.height, 3, ALP_COMPONENT_U8};
    ALP_TRY(alp_image_create(atlas->context, info, image));
    painter p = {atlas, alp_image_bytes(*image)};
    alp_result result = alpi_raster(atlas, page, page + 1, paint_band, &p);
    if (result != ALP_OK) {
        alp_image_destroy(*image);
        *image = NULL;
    }
    return result;
}
