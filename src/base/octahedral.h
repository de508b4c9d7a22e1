// SPDX-License-Identifier: MIT
// The octahedral map: all directions on a unit square.
//
//     p = d / (|dx| + |dy| + |dz|)
//     q = (px, py)                                    where pz >= 0
//     q = ((1 - |py|) s(px), (1 - |px|) s(py))        where pz < 0
//     u = (qx + 1) / 2,   v = (qy + 1) / 2            s(x) is 1 where x >= 0, else -1
//
// +z is the centre of the square, -z its four corners.
// After: Q. Meyer, J. Süßmuth, G. Sußner, M. Stamminger, G. Greiner. On Floating-Point Normal
//        Vectors. EGSR 2010.
#ifndef ALPI_BASE_OCTAHEDRAL_H
#define ALPI_BASE_OCTAHEDRAL_H

#include "base/vec.h"

/// The point (u, v) in [0, 1]² of a direction, which need not have length 1 but must not be zero.
static inline vec2 alpi_octahedral_encode(vec3 direction)
{
    const float scale = 1.0f / (fabsf(direction.x) + fabsf(direction.y) + fabsf(direction.z));
    const float x = direction.x * scale, y = direction.y * scale;
    const float folded_x = (1.0f - fabsf(y)) * (x >= 0.0f ? 1.0f : -1.0f);
    const float folded_y = (1.0f - fabsf(x)) * (y >= 0.0f ? 1.0f : -1.0f);
    const bool below = direction.z < 0.0f;
    return (vec2){0.5f * (below ? folded_x : x) + 0.5f, 0.5f * (below ? folded_y : y) + 0.5f};
}

/// The unit vector of a point in [0, 1]².
static inline vec3 alpi_octahedral_decode(vec2 point)
{
    const float x = 2.0f * point.x - 1.0f, y = 2.0f * point.y - 1.0f;
    const float z = 1.0f - fabsf(x) - fabsf(y);
    const float fold = fmaxf(-z, 0.0f); // how far the point lies outside the upper half
    const vec3 d = {x - (x >= 0.0f ? fold : -fold), y - (y >= 0.0f ? fold : -fold), z};
    return vec3_scale(d, 1.0f / vec3_length(d));
}

#endif
