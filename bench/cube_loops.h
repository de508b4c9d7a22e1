// SPDX-License-Identifier: MIT
// Loops over cube maps to compare projection with.
#ifndef BENCH_CUBE_LOOPS_H
#define BENCH_CUBE_LOOPS_H

#include "sh/sh9.h"

#include <stdint.h>

/// The loop that one writes first: direction of the texel, solid angle, basis, 27 sums.
/// @param pixels [6][size][size][3]
alp_sh9 bench_cube_naive(const float *pixels, uint32_t size);
/// The same with the axes of a face outside of its loop, compiled as the inner loop of projection.
alp_sh9 bench_cube_hoisted(const float *pixels, uint32_t size);

/// Reads every value and adds them: no loop over these pixels can be faster.
float bench_cube_read(const float *pixels, uint32_t size);

#endif
