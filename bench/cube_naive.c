// SPDX-License-Identifier: MIT
// Projection as one writes it first, compiled as most files are.
#include "cube_loops.h"

#include "sh/cube_map.h"

alp_sh9 bench_cube_naive(const float *pixels, uint32_t size)
{
    alp_sh9 sums = {{{0.0f}}};
    float total = 0.0f;
    for (uint32_t i = 0; i < ALPI_CUBE_FACES * size * size; i++, pixels += 3) {
        const uint32_t x = i % size, y = i / size % size;
        const float s = 2.0f * ((float)x + 0.5f) / (float)size - 1.0f;
        const float t = 2.0f * ((float)y + 0.5f) / (float)size - 1.0f;
        const float square = 1.0f + s * s + t * t, weight = 4.0f / (square * sqrtf(square));
        float basis[ALPI_SH9_COUNT];
        alpi_sh9_basis(alpi_cube_texel_direction((alp_cube_face)(i / size / size), size, x, y),
                       basis);
        total += weight;
        for (int b = 0; b < ALPI_SH9_COUNT; b++) {
            for (int k = 0; k < 3; k++) {
                sums.c[b][k] += pixels[k] * basis[b] * weight;
            }
        }
    }
    for (int b = 0; b < 3 * ALPI_SH9_COUNT; b++) {
        sums.c[b / 3][b % 3] *= (float)(4.0 * ALPI_PI) / total;
    }
    return sums;
}
