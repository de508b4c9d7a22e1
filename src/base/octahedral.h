// SPDX-License-Identifier: MIT
// The octahedral map: directions of the sphere to the unit square and back.
//
// p = d / (|x| + |y| + |z|). The lower half (z < 0) is folded outwards:
// (px, py) → ((1 − |py|) sign px, (1 − |px|) sign py). Then uv = (px, py) / 2 + ½.
// Based on: Q. Meyer et al. On Floating-Point Normal Vectors. EGSR 2010.
#ifndef ALPI_BASE_OCTAHEDRAL_H
#define ALPI_BASE_OCTAHEDRAL_H

#include "base/vec.h"

/// @param direction any length but 0   @return uv in [0, 1]²
static inline vec2 alpi_octahedral_encode(vec3 direction)
{
    const float inverse = 1.0f / (fabsf(direction.x) + fabsf(direction.y) + fabsf(direction.z));
    const float x = direction.x * inverse, y = direction.y * inverse;
    const float folded_x = copysignf(1.0f - fabsf(y), x), folded_y = copysignf(1.0f - fabsf(x), y);
    const bool below = direction.z < 0.0f;
    return (vec2){(below ? folded_x : x) * 0.5f + 0.5f, (below ? folded_y : y) * 0.5f + 0.5f};
}

/// @param uv in [0, 1]²   @return unit
static inline vec3 alpi_octahedral_decode(vec2 uv)
{
    const float x = 2.0f * uv.x - 1.0f, y = 2.0f * uv.y - 1.0f;
    const float z = 1.0f - fabsf(x) - fabsf(y), below = fmaxf(-z, 0.0f);
    const vec3 d = {x - copysignf(below, x), y - copysignf(below, y), z};
    return vec3_scale(d, 1.0f / vec3_length(d));
}

#endif
