// SPDX-License-Identifier: MIT
// The final gather of a round: rays of texels read the light of the solution.
#ifndef ALPI_BAKE_LIGHT_GATHER_H
#define ALPI_BAKE_LIGHT_GATHER_H

#include "bake/light/light_state.h"

/// The error of bounced light falls with rays^−this. Measured over successive rounds: .6 to .7.
#define ALPI_LIGHT_RAYS_POWER 0.62

/// Rays of a round's texels, and the scene that they read. It points into itself.
typedef struct alpi_light_tracing {
    alpi_gather_scene from;
    alpi_reference near;
    alpi_cosine_rays cosine, others;
    alpi_gatherer own, beside; // of other random numbers: for texels that are gathered twice
    alpi_gather_job gather;    // without a list and values
} alpi_light_tracing;

/// @param rays of a texel, from alpi_light_ray_count; a fixed gatherer has its own number
void alpi_light_tracing_start(const alpi_light_rounds *rounds, uint32_t rays, uint64_t seed,
                              alpi_light_tracing *tracing);
/// `rays` rounded up to a number that makes replicates.
uint32_t alpi_light_ray_count(double rays);
/// The seed of the rays of a round, or of its samples of direct light. Bakes with successive seeds
/// share none.
uint64_t alpi_light_round_seed(const alpi_light_rounds *rounds, bool direct);

/// Texels that trace rays in this round, or may: the worst, or all.
const uint32_t *alpi_light_senders(const alpi_light_rounds *rounds, uint32_t *count);

/// Relights the solution for the rays of the next round. From the second round on, cells read the
/// light that texels gathered, which is finer than that of patches. Not with a number of bounces,
/// where texels have one bounce more; nor with layers, whose light is apart. If only some surfaces
/// are baked, rays read another atlas, and nothing is relit.
/// @param rays  of a texel, so far
/// @param noise out: 1 / √rays of the light of a patch
/// @return ALP_OK; CANCELLED
alp_result alpi_light_relight(const alpi_light_rounds *rounds, uint32_t rays, double *noise);

/// Gathers bounced light with `rays` more rays of each texel that traces any.
/// @param into out
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_gather(alpi_light_rounds *rounds, uint32_t rays,
                             const alpi_light_fresh *into);

#endif
