// SPDX-License-Identifier: MIT
// Loops over cube maps to compare projection with, compiled as the inner loop of projection is.
#include "cube_loops.h"

#include "sh/cube_map.h"

#include <string.h>

alp_sh9 bench_cube_naive(const float *pixels, uint32_t size)
{
    alp_sh9 sums = {{{0.0f}}};
    float total = 0.0f;
    for (int face = 0; face < ALPI_CUBE_FACES; face++) {
        const alpi_cube_axes *a = alpi_cube_face_axes((alp_cube_face)face);
        for (uint32_t y = 0; y < size; y++) {
            for (uint32_t x = 0; x < size; x++, pixels += 3) {
                const float s = 2.0f * ((float)x + 0.5f) / (float)size - 1.0f;
                const float t = 2.0f * ((float)y + 0.5f) / (float)size - 1.0f;
                const float square = 1.0f + s * s + t * t, length = sqrtf(square);
                const float weight = 4.0f / (square * length);
                float basis[ALPI_SH9_COUNT];
                alpi_sh9_basis(
                    (vec3){(s * (float)a->s[0] + t * (float)a->t[0] + (float)a->n[0]) / length,
                           (s * (float)a->s[1] + t * (float)a->t[1] + (float)a->n[1]) / length,
                           (s * (float)a->s[2] + t * (float)a->t[2] + (float)a->n[2]) / length},
                    basis);
                total += weight;
                for (int i = 0; i < ALPI_SH9_COUNT; i++) {
                    for (int k = 0; k < 3; k++) {
                        sums.c[i][k] += pixels[k] * basis[i] * weight;
                    }
                }
            }
        }
    }
    for (int i = 0; i < ALPI_SH9_COUNT; i++) {
        for (int k = 0; k < 3; k++) {
            sums.c[i][k] *= (float)(4.0 * ALPI_PI) / total;
        }
    }
    return sums;
}

float bench_cube_read(const float *pixels, uint32_t size)
{
    enum { LANES = 32 };
    const size_t count = (size_t)18 * size * size;
    float lanes[LANES], sum = 0.0f;
    size_t i = 0;
    memset(lanes, 0, sizeof lanes);
    for (; i + LANES <= count; i += LANES) {
        for (size_t k = 0; k < LANES; k++) {
            lanes[k] += pixels[i + k];
        }
    }
    for (; i < count; i++) {
        sum += pixels[i];
    }
    for (size_t k = 0; k < LANES; k++) {
        sum += lanes[k];
    }
    return sum;
}
