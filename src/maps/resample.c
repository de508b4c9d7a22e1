// SPDX-License-Identifier: MIT
// A baked map in the layout of another texture: each of its texels gets the mean of the map over
// the surface inside it.
#include "maps/lightmap.h"

#include "base/memory.h"

#include <math.h>

enum { PARTS_LIMIT = 8 };
// Sums are whole numbers, so that they are the same in whatever order workers add to them.
static const double ONE = 0x1p40; // of a coverage of 1; 64 of them stay below 2^47

typedef struct resampling {
    const alp_lightmap *map;
    const alpi_lightmap_weight *weight;
    uint32_t parts, width;
    uint64_t (*sums)[2]; // [texels] coverage × value, coverage
} resampling;

/// Texels of the layout's page under its triangles, which do not overlap.
static double covered_texels(const alp_atlas *layout)
{
    double area = 0.0;
    for (uint32_t t = 0; t < layout->scene->triangle_count; t++) {
        const float(*p)[2] = (const float(*)[2])layout->corner_uvs[t];
        if (layout->triangle_pages[t] == 0) {
            double ax = (double)p[1][0] - (double)p[0][0], ay = (double)p[1][1] - (double)p[0][1];
            double bx = (double)p[2][0] - (double)p[0][0], by = (double)p[2][1] - (double)p[0][1];
            area += 0.5 * fabs(ax * by - ay * bx);
        }
    }
    return area * layout->info.width * layout->info.height;
}

/// Into how many parts along each side a texel of the layout is divided, so that no texel of the
/// map is passed over: the root of how many of them come to one of the layout's.
static uint32_t choose_parts(const alp_lightmap *map, const alp_atlas *layout)
{
    const alpi_texels *texels = &map->texels;
    double fine = 0.0, coarse = covered_texels(layout);
    for (uint32_t i = 0; i < texels->count; i++) {
        if (layout->triangle_pages[texels->triangles[i]] == 0) {
            fine += (double)texels->coverages[i];
        }
    }
    double wanted = coarse > 0.0 ? ceil(sqrt(fine / coarse) - 0.1) : 1.0;
    uint32_t side =
        layout->info.width > layout->info.height ? layout->info.width : layout->info.height;
    wanted = fmin(wanted, floor((double)ALPI_IMAGE_SIDE_LIMIT / side));
    return (uint32_t)fmin(fmax(wanted, 1.0), PARTS_LIMIT);
}

static void add_cell(void *user, const alpi_uv_cell *cell)
{
    const resampling *r = user;
    uint32_t x = cell->x / r->parts, y = cell->y / r->parts;
    const float *b = cell->barycentrics;
    float rgb[3];
    alpi_lightmap_sample(r->map, cell->triangle, b[0], b[1], rgb);
    float value = rgb[0];
    if (r->weight->at != NULL) {
        value *= r->weight->at(r->weight->user, cell, x, y);
    }
    double coverage = (double)cell->coverage * ONE;
    value = fminf(fmaxf(value, 0.0f), 1.0f);
    uint64_t *sums = r->sums[(size_t)y * r->width + x];
    __atomic_fetch_add(&sums[0], (uint64_t)(coverage * (double)value), __ATOMIC_RELAXED);
    __atomic_fetch_add(&sums[1], (uint64_t)coverage + 1, __ATOMIC_RELAXED); // never 0
}

alp_result alpi_lightmap_resample(const alp_lightmap *map, const alp_atlas *layout,
                                  const alpi_lightmap_weight *weight, float *page)
{
    uint32_t width = layout->info.width, height = layout->info.height;
    size_t count = (size_t)width * height;
    resampling r = {
        .map = map, .weight = weight, .parts = choose_parts(map, layout), .width = width};
    ALPI_TRY_NEW(map->context, r.sums, count);
    alp_result result = alpi_uv_layout_visit(layout, r.parts, add_cell, &r);
    for (size_t i = 0; i < count; i++) {
        bool covered = r.sums[i][1] > 0;
        float value = covered ? (float)((double)r.sums[i][0] / (double)r.sums[i][1]) : 0.0f;
        page[4 * i] = page[4 * i + 1] = page[4 * i + 2] = value;
        page[4 * i + 3] = covered ? 1.0f : 0.0f;
    }
    alpi_release(map->context, r.sums);
    return result == ALP_OK ? alpi_dilate(map->context, page, width, height) : result;
}
