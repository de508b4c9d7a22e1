// SPDX-License-Identifier: MIT
// Loops over cube maps to compare projection with, compiled as the inner loop of projection is.
#include "cube_loops.h"

#include <string.h>

alp_sh9 bench_cube_naive_wide(const float *pixels, uint32_t size)
{
    return bench_cube_naive(pixels, size);
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
