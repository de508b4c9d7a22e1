// SPDX-License-Identifier: MIT
// The matrix of a node that looks along its −Z axis, as cameras and lights of viewers do.
#ifndef ALPI_BASE_LOOK_H
#define ALPI_BASE_LOOK_H

#include "base/vec.h"

/// Column-major matrix whose −Z axis is `forward`. Another axis replaces an `up` that is parallel.
static inline void alpi_look_matrix(vec3 position, vec3 forward, vec3 up, float m[16])
{
    vec3 z = vec3_normalize_or(vec3_scale(forward, -1.0f), (vec3){0.0f, 0.0f, 1.0f});
    vec3 fallback = fabsf(z.y) < 0.9f ? (vec3){0.0f, 1.0f, 0.0f} : (vec3){1.0f, 0.0f, 0.0f};
    vec3 side = vec3_normalize_or(vec3_cross(fallback, z), (vec3){1.0f, 0.0f, 0.0f});
    const vec3 columns[4] = {
        vec3_normalize_or(vec3_cross(up, z), side), {0.0f, 0.0f, 0.0f}, z, position};
    for (int c = 0; c < 4; c++) {
        vec3 v = c == 1 ? vec3_cross(z, columns[0]) : columns[c];
        vec3_store(m + 4 * c, v);
        m[4 * c + 3] = c == 3 ? 1.0f : 0.0f;
    }
}

#endif
