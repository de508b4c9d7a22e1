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
    alpi_gatherer own, independent; // of other random numbers: for texels that are gathered twice
    alpi_gather_job gather;         // without a list and values
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
const uint32_t *alpi_light_tracing_texels(const alpi_light_rounds *rounds, uint32_t *count);

/// Relights the solution for the rays of the next round. Cells take the light that texels gathered,
/// once it is known by more rays than that of patches. Three cases keep to patches:
/// - A number of bounces: the texels' light has one bounce more.
/// - Layers: their light is apart.
/// - Some surfaces baked alone (--only): rays read another atlas, and nothing is relit.
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
