// SPDX-License-Identifier: MIT
#include "maps/lookup.h"

#include <math.h>

static uint32_t clamp(double index, uint32_t size)
{
    return index < 0.0 ? 0 : index >= (double)size ? size - 1 : (uint32_t)index;
}

/// Adds a bilinear look-up in one coordinate set, of `share` of the whole.
static void add_set(const alp_lightmap *l, uint32_t triangle, const double b[3], int set,
                    double share, alpi_lookup *lookup)
{
    const uint32_t w = l->width, h = l->height;
    double x = -0.5, y = -0.5;
    for (int k = 0; k < 3; k++) {
        const float *uv = alpi_atlas_set_uv(l->atlas, triangle, set, k);
        x += b[k] * (double)uv[0] * w;
        y += b[k] * (double)uv[1] * h;
    }
    const double fx = floor(x), fy = floor(y);
    const uint32_t columns[2] = {clamp(fx, w), clamp(fx + 1.0, w)};
    const uint32_t rows[2] = {clamp(fy, h), clamp(fy + 1.0, h)};
    const double across[2] = {1.0 - (x - fx), x - fx}, down[2] = {1.0 - (y - fy), y - fy};
    const size_t page = l->atlas->triangle_pages[triangle];
    for (int i = 0; i < 4; i++) {
        lookup->texels[lookup->count] = (page * h + rows[i / 2]) * w + columns[i % 2];
        lookup->weights[lookup->count++] = share * down[i / 2] * across[i % 2];
    }
}

void alpi_lookup_at(const alp_lightmap *lightmap, uint32_t triangle, double b1, double b2,
                    alpi_lookup *lookup)
{
    const double b[3] = {1.0 - b1 - b2, b1, b2};
    float shares[3];
    alpi_lightmap_shares(lightmap, triangle, (float)b1, (float)b2, shares);
    lookup->count = 0;
    for (int set = 0; set < alpi_atlas_set_count(lightmap->atlas); set++) {
        add_set(lightmap, triangle, b, set, (double)shares[set], lookup);
    }
}
