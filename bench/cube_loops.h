// SPDX-License-Identifier: MIT
// Loops over cube maps to compare projection with.
#ifndef BENCH_CUBE_LOOPS_H
#define BENCH_CUBE_LOOPS_H

#include "sh/cube_map.h"
#include "sh/sh9.h"

#include <stdint.h>

/// The loop that one writes first: direction, solid angle and basis of each texel, 27 sums.
/// @param pixels [6][size][size][3]
static inline alp_sh9 bench_cube_naive(const float *pixels, uint32_t size)
{
    alp_sh9 sums = {{{0.0f}}};
    float total = 0.0f;
    for (int face = 0; face < ALPI_CUBE_FACES; face++) {
        const alpi_cube_axes *axes = alpi_cube_face_axes((alp_cube_face)face);
        float a[3][3] = {{0.0f}}; // s, t and n of the face
        a[0][axes->s.index] = (float)axes->s.sign;
        a[1][axes->t.index] = (float)axes->t.sign;
        a[2][axes->n.index] = (float)axes->n.sign;
        for (uint32_t y = 0; y < size; y++) {
            for (uint32_t x = 0; x < size; x++, pixels += 3) {
                const float s = 2.0f * ((float)x + 0.5f) / (float)size - 1.0f;
                const float t = 2.0f * ((float)y + 0.5f) / (float)size - 1.0f;
                const float square = 1.0f + s * s + t * t, length = sqrtf(square);
                const float weight = 4.0f / (square * length);
                float basis[ALPI_SH9_COUNT];
                alpi_sh9_basis((vec3){(s * a[0][0] + t * a[1][0] + a[2][0]) / length,
                                      (s * a[0][1] + t * a[1][1] + a[2][1]) / length,
                                      (s * a[0][2] + t * a[1][2] + a[2][2]) / length},
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

/// The same with the compiler options of the inner loop of projection.
alp_sh9 bench_cube_naive_wide(const float *pixels, uint32_t size);

/// Reads every value and adds them: no loop over these pixels can be faster.
float bench_cube_read(const float *pixels, uint32_t size);

#endif
