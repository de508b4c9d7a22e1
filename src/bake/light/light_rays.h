// SPDX-License-Identifier: MIT
// Rays of a round of light: how they are sent, and what they meet.
#ifndef ALPI_BAKE_LIGHT_RAYS_H
#define ALPI_BAKE_LIGHT_RAYS_H

#include "bake/light/light_next.h"
#include "transport/gather/cosine_rays.h"

/// Rays of a round's texels, and others of other random numbers, for texels that have some twice.
/// It points into itself.
typedef struct alpi_light_rays {
    alpi_gather_scene from;
    alpi_reference near;
    alpi_cosine_rays cosine, others;
    alpi_gatherer own, beside;
    alpi_gather_job gather; // of no list, and to no values yet
} alpi_light_rays;

/// `rays` rounded up to a number that makes replicates.
uint32_t alpi_light_ray_count(double rays);

/// @param rays of a texel, a number that makes replicates; the round's own gatherer,
/// where it has one, has its own number
void alpi_light_rays_start(const alpi_light_round_state *round, uint32_t rays, uint64_t seed,
                           alpi_light_rays *by);

/// Of the rays of a round, or of its samples of direct light, which has rounds of its own. Bakes by
/// seeds that follow each other share none.
uint64_t alpi_light_round_seed(const alpi_light_round_state *round, bool direct);

#endif
