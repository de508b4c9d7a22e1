// SPDX-License-Identifier: MIT
// Loops to compare projection with, compiled as its inner loop is.
#include "cube_loops.h"

#include "sh/cube_map.h"

#include <string.h>

alp_sh9 bench_cube_hoisted(const float *pixels, uint32_t size)
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
    for (int b = 0; b < 3 * ALPI_SH9_COUNT; b++) {
        sums.c[b / 3][b % 3] *= (float)(4.0 * ALPI_PI) / total;
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
