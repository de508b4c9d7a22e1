// SPDX-License-Identifier: MIT
// Light straight from sources, by rays aimed at them: emissive surfaces, and bright spots of the
// sky. Jittered pixels meet small sources too seldom.
//
// The light sampler draws for a hemisphere. Each replicate draws pairs, one on each side of a
// random axis. Emission that rays are aimed at does not count where pixels meet it.
#ifndef ALPI_TRANSPORT_SPHERE_AIMED_H
#define ALPI_TRANSPORT_SPHERE_AIMED_H

#include "transport/sphere/sphere_rays.h"

/// Pairs of a replicate, a multiple of 4: a quarter of a face's pixels, so that their noise falls
/// with the number of rays.
static inline uint32_t alpi_sphere_pairs(const alpi_sphere_rays *rays)
{
    return rays->face * rays->face / 4;
}

/// How the rays of a replicate are aimed.
typedef struct alpi_sphere_aim {
    const alpi_sphere_rays *rays;
    vec3 point, axis;
    uint32_t key, pairs;
} alpi_sphere_aim;

alpi_sphere_aim alpi_sphere_aim_for(const alpi_sphere_rays *rays, vec3 point, uint32_t key);

/// Adds ∫ L Y dω of what the aimed rays find.
void alpi_sphere_aimed_light(const alpi_sphere_aim *aim, const alpi_sphere_loops *loops,
                             alpi_sphere_tallies *tallies);

#endif
