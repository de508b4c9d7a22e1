// SPDX-License-Identifier: MIT
#include "transport/sphere/sphere_occluders.h"

#include <math.h>

/// Whether a ray meets a sphere from outside before its end.
static bool is_stopped(const alpi_rays *rays, int i, vec3 centre, float radius, float reach)
{
    const vec3 origin = {rays->origin_x[i], rays->origin_y[i], rays->origin_z[i]};
    const vec3 direction = {rays->direction_x[i], rays->direction_y[i], rays->direction_z[i]};
    const vec3 way = vec3_sub(centre, origin);
    const float along = vec3_dot(way, direction), square = radius * radius;
    const vec3 aside = vec3_sub(way, vec3_scale(direction, along));
    const float half = square - vec3_dot(aside, aside); // squared half of the chord
    return along > 0.0f && half > 0.0f && vec3_dot(way, way) > square &&
           along - sqrtf(half) < reach;
}

uint32_t alpi_occluders_open(const alpi_occluders *occluders, const alpi_rays *rays,
                             const float reach[ALPI_PACKET], uint32_t active)
{
    uint32_t open = active;
    for (uint32_t k = 0; occluders != NULL && k < occluders->count; k++) {
        for (uint32_t lanes = open; lanes != 0; lanes &= lanes - 1) {
            const int i = __builtin_ctz(lanes);
            if (is_stopped(rays, i, occluders->centres[k], occluders->radii[k], reach[i])) {
                open &= ~(1u << i);
            }
        }
    }
    return open;
}
