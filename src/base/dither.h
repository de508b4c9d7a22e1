// SPDX-License-Identifier: MIT
// Rounding with noise, so that a smooth ramp has no steps and every mean is kept.
// Based on: Stanley P. Lipshitz, Robert A. Wannamaker, John Vanderkooy. Quantization and Dither: A
// Theoretical Survey. Journal of the Audio Engineering Society 40(5), 1992.
#ifndef ALPI_BASE_DITHER_H
#define ALPI_BASE_DITHER_H

#include "base/random.h"

#include <math.h>

/// A whole number from 0 to 255 whose expected value is `value` in [0, 255]; whole ends stay. Noise
/// is triangular, of two steps, so that its variance does not follow the value either; within half
/// a step of the ends it is even, of one step, so that nothing is cut off.
/// @param key of alpi_random_key
static inline uint8_t alpi_dither_byte(float value, uint32_t key)
{
    const float u = alpi_unit_float(alpi_hash32(key)), v = alpi_unit_float(alpi_hash32(~key));
    const bool inside = value >= 0.5f && value <= 254.5f;
    const float noisy = inside ? value + (u + v - 0.5f) : value + u;
    return (uint8_t)fminf(fmaxf(floorf(noisy), 0.0f), 255.0f);
}

#endif
