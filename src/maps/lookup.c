// SPDX-License-Identifier: MIT
#include "maps/lookup.h"

#include <math.h>

static uint32_t clamp(double index, uint32_t size)
{
    return index < 0.0 ? 0 : index >= (double)size ? size - 1 : (uint32_t)index;
}

void alpi_lookup_at(const alp_lightmap *lightmap, uint32_t triangle, double b1, double b2,
                    alpi_lookup *lookup)
{
    const float(*uv)[2] = (const float(*)[2])lightmap->atlas->corner_uvs[triangle];
    const uint32_t w = lightmap->width, h = lightmap->height;
    const double b0 = 1.0 - b1 - b2;
    const double x =
        (b0 * (double)uv[0][0] + b1 * (double)uv[1][0] + b2 * (double)uv[2][0]) * w - 0.5;
    const double y =
        (b0 * (double)uv[0][1] + b1 * (double)uv[1][1] + b2 * (double)uv[2][1]) * h - 0.5;
    const double fx = floor(x), fy = floor(y);
    const uint32_t columns[2] = {clamp(fx, w), clamp(fx + 1.0, w)};
    const uint32_t rows[2] = {clamp(fy, h), clamp(fy + 1.0, h)};
    const double across[2] = {1.0 - (x - fx), x - fx}, down[2] = {1.0 - (y - fy), y - fy};
    const size_t page = lightmap->atlas->triangle_pages[triangle];
    lookup->count = 4;
    for (int i = 0; i < 4; i++) {
        lookup->texels[i] = (page * h + rows[i / 2]) * w + columns[i % 2];
        lookup->weights[i] = down[i / 2] * across[i % 2];
    }
}
