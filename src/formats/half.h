// SPDX-License-Identifier: MIT
// Half floats, IEEE 754 binary16.
#ifndef ALPI_FORMATS_HALF_H
#define ALPI_FORMATS_HALF_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#define ALPI_HALF_MAX 65504.0f

/// The nearest half, ties to even. What is too large becomes the largest, NaN becomes 0: neither
/// has a place in a map.
static inline uint16_t alpi_half_from_float(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint32_t sign = bits >> 16 & 0x8000u, size = bits & 0x7fffffffu;
    if (size > 0x7f800000u) {
        return 0;
    }
    if (size >= 0x477ff000u) { // 65520: from here on the nearest would be infinity
        return (uint16_t)(sign | 0x7bffu);
    }
    if (size < 0x38800000u) { // 2⁻¹⁴: a multiple of 2⁻²⁴
        return (uint16_t)(sign | (uint32_t)rintf(fabsf(value) * 0x1p24f));
    }
    size += 0xfffu + (size >> 13 & 1u);
    return (uint16_t)(sign | (size - 0x38000000u) >> 13);
}

#endif
