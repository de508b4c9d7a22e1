// SPDX-License-Identifier: MIT
// Half floats: IEEE 754 binary16, 1 bit of sign, 5 of exponent, 10 of mantissa.
#ifndef ALPI_BASE_HALF_H
#define ALPI_BASE_HALF_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#define ALPI_HALF_MAX 65504.0f

/// The nearest half float, of two as near the even one; beyond 65520 infinity, NaN stays NaN.
static inline uint16_t alpi_half_from_float(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    const uint32_t sign = bits >> 16 & 0x8000u;
    const float size = fabsf(value);
    if (!(size < 65520.0f)) {
        return (uint16_t)(sign | (size != size ? 0x7e00u : 0x7c00u));
    }
    if (size < 0x1p-14f) { // below the normal ones: a multiple of 2^-24, which the sum rounds to
        const float magic = 0.5f;
        const float sum = size + magic;
        uint32_t steps;
        memcpy(&steps, &sum, sizeof steps);
        return (uint16_t)(sign | (steps & 0x7ffu));
    }
    bits &= 0x7fffffffu;
    const uint32_t rounded = bits + 0xfffu + (bits >> 13 & 1u); // ties go to the even mantissa
    return (uint16_t)(sign | (rounded - 0x38000000u) >> 13);
}

static inline float alpi_half_to_float(uint16_t half)
{
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    const float sign = (half & 0x8000u) != 0 ? -1.0f : 1.0f;
    if (exponent == 31) {
        return mantissa != 0 ? NAN : sign * INFINITY;
    }
    return sign * (exponent == 0 ? ldexpf((float)mantissa, -24)
                                 : ldexpf((float)(1024 + mantissa), exponent - 25));
}

#endif
