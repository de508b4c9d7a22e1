// SPDX-License-Identifier: MIT
// Black spheres that stop rays and are in no scene: objects that move.
//
// They act when hits are lit, not when these are traced. So kept hits stay those of the scene, and
// light follows a sphere by relighting. A ray that starts inside a sphere passes it: the air in an
// object is lit as without that object.
#ifndef ALPI_TRANSPORT_SPHERE_OCCLUDERS_H
#define ALPI_TRANSPORT_SPHERE_OCCLUDERS_H

#include "base/vec.h"
#include "trace/trace.h"

enum { ALPI_OCCLUDERS_MOST = 16 };

typedef struct alpi_occluders {
    uint32_t count;
    vec3 centres[ALPI_OCCLUDERS_MOST]; // metres
    float radii[ALPI_OCCLUDERS_MOST];  // metres, > 0
} alpi_occluders;

/// Rays that no sphere stops.
/// @param occluders NULL: none
/// @param reach     metres that each ray goes, INFINITY allowed
/// @param active    bit i: lane i, whose direction is unit
/// @return bits of the active lanes that are open
uint32_t alpi_occluders_open(const alpi_occluders *occluders, const alpi_rays *rays,
                             const float reach[ALPI_PACKET], uint32_t active);

#endif
