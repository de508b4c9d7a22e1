// SPDX-License-Identifier: MIT
// Square to direction, about +z. Each warp is area-preserving up to its stated density, so a
// stratified square stays stratified.
#ifndef ALPI_BASE_WARP_H
#define ALPI_BASE_WARP_H

#include "base/vec.h"

/// Concentric map of the unit square to the unit disk: area times π.
/// Shirley, Chiu: A Low Distortion Map Between Disk and Square. JGT 2(3), 1997.
static inline vec2 alpi_warp_disk(vec2 u)
{
    float a = 2.0f * u.x - 1.0f, b = 2.0f * u.y - 1.0f;
    float radius = a, phi = 0.0f;
    const float quarter = (float)(ALPI_PI / 4.0);
    if (a == 0.0f && b == 0.0f) {
        return (vec2){0.0f, 0.0f};
    }
    if (fabsf(a) > fabsf(b)) {
        phi = quarter * (b / a);
    } else {
        radius = b;
        phi = 2.0f * quarter - quarter * (a / b);
    }
    return (vec2){radius * cosf(phi), radius * sinf(phi)};
}

/// Cosine-distributed direction in the cone of half-angle θmax: density cosθ / (π sin²θmax).
/// sin²θmax = 1 is the hemisphere. (Malley: a disk of radius sinθmax lifted to the sphere.)
static inline vec3 alpi_warp_cosine_cone(vec2 u, float sin2_max)
{
    vec2 d = alpi_warp_disk(u);
    float scale = sqrtf(sin2_max);
    d.x *= scale;
    d.y *= scale;
    float z2 = 1.0f - d.x * d.x - d.y * d.y;
    return (vec3){d.x, d.y, sqrtf(fmaxf(z2, 0.0f))};
}

/// Uniform direction in the cone of half-angle θmax: density 1 / (2π (1 − cosθmax)).
static inline vec3 alpi_warp_uniform_cone(vec2 u, float cos_max)
{
    vec2 d = alpi_warp_disk(u);
    float r2 = d.x * d.x + d.y * d.y;
    float h = 1.0f - cos_max; // z = 1 − h r², so that z is uniform in [cosθmax, 1]
    float scale = sqrtf(fmaxf(h * (2.0f - h * r2), 0.0f));
    return (vec3){d.x * scale, d.y * scale, 1.0f - h * r2};
}

#endif
