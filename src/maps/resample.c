// SPDX-License-Identifier: MIT
// A baked map in the layout of another texture: each of its texels gets the mean of the map over
// the surface inside it.
#include "maps/lightmap.h"

#include <math.h>
#include <string.h>

enum { PARTS_LIMIT = 8 };

typedef struct resampling {
    const alp_lightmap *map;
    const alp_atlas *layout;
    const alpi_lightmap_weight *weight;
    uint32_t parts;
    float *page;
} resampling;

/// Adds up, per texel, the share of the layout's texels that is covered.
static alp_result add_coverage(void *user, const alpi_uv_cell *cell)
{
    *(double *)user += (double)cell->coverage;
    return ALP_OK;
}

/// Into how many parts along each side a texel of the layout is divided, so that no texel of the
/// map is passed over: the root of how many of them come to one of the layout's.
static alp_result choose_parts(const alp_lightmap *map, const alp_atlas *layout, uint32_t *parts)
{
    const alpi_texels *texels = &map->texels;
    double fine = 0.0, coarse = 0.0;
    for (uint32_t i = 0; i < texels->count; i++) {
        if (layout->triangle_pages[texels->triangles[i]] == 0) {
            fine += (double)texels->coverages[i];
        }
    }
    ALP_TRY(alpi_uv_layout_visit(layout, 1, add_coverage, &coarse));
    double wanted = coarse > 0.0 ? ceil(sqrt(fine / coarse) - 0.1) : 1.0;
    uint32_t side =
        layout->info.width > layout->info.height ? layout->info.width : layout->info.height;
    wanted = fmin(wanted, floor((double)ALPI_IMAGE_SIDE_LIMIT / side));
    *parts = (uint32_t)fmin(fmax(wanted, 1.0), PARTS_LIMIT);
    return ALP_OK;
}

static alp_result add_cell(void *user, const alpi_uv_cell *cell)
{
    const resampling *r = user;
    uint32_t x = cell->x / r->parts, y = cell->y / r->parts;
    const float *b = cell->barycentrics;
    float rgb[3];
    alpi_lightmap_sample(r->map, cell->triangle, b[0], b[1], rgb);
    if (r->weight->at != NULL) {
        rgb[0] *= r->weight->at(r->weight->user, cell, x, y);
    }
    float *pixel = r->page + 4 * ((size_t)y * r->layout->info.width + x);
    pixel[0] += cell->coverage * rgb[0];
    pixel[3] += cell->coverage;
    return ALP_OK;
}

alp_result alpi_lightmap_resample(const alp_lightmap *map, const alp_atlas *layout,
                                  const alpi_lightmap_weight *weight, float *page)
{
    uint32_t width = layout->info.width, height = layout->info.height;
    size_t count = (size_t)width * height;
    resampling r = {.map = map, .layout = layout, .weight = weight, .page = page};
    ALP_TRY(choose_parts(map, layout, &r.parts));
    memset(page, 0, 4 * count * sizeof *page);
    ALP_TRY(alpi_uv_layout_visit(layout, r.parts, add_cell, &r));
    for (size_t i = 0; i < count; i++) {
        float *pixel = page + 4 * i;
        if (pixel[3] > 0.0f) {
            pixel[0] /= pixel[3];
            pixel[1] = pixel[2] = pixel[0];
            pixel[3] = 1.0f;
        }
    }
    return alpi_dilate(map->context, page, width, height);
}
