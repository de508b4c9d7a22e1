// SPDX-License-Identifier: MIT
// Held-out texels: some texels, chosen at random, whose extra rays take no part in the map.
//
// The error of quasi-Monte Carlo cannot be estimated from its own samples: parts of one sequence
// are not independent, and independent shorter sequences have up to a quarter more error
// (docs/measured/accuracy.md). No sample shows the error of interpolation. So each held-out texel
// gets two more estimates y₁, y₂, independent of the map's value x and of each other. Then
//
//     E[(x − y₁)(x − y₂)] = (x − truth)²
//
// for traced and interpolated x alike.
#ifndef ALPI_BAKE_OCCLUSION_HELD_OUT_H
#define ALPI_BAKE_OCCLUSION_HELD_OUT_H

#include "bake/occlusion/occlusion_rounds.h"
#include "maps/texels/chart_deal.h"

typedef struct alpi_occlusion_held_out {
    alp_context *context;
    const alpi_receivers *receivers; // texels of the atlas
    uint32_t count;
    uint32_t *texels;               // [count]
    uint32_t *list;                 // [count] indices in `texels`, chart by chart
    alpi_occlusion_setup setups[2]; // the map's, with other random numbers
    alpi_occlusion_sums sums[2];    // [count]
} alpi_occlusion_held_out;

/// Chooses `count` texels of a task, stratified over its order. @param deal of the task's charts
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_occlusion_held_out_create(const alpi_occlusion_task *task, uint32_t count,
                                          alpi_chart_deal *deal, alpi_occlusion_held_out *held_out);
void alpi_occlusion_held_out_destroy(alpi_occlusion_held_out *held_out); ///< zeroed: does nothing

/// Traces samples [before, samples) of both estimates of all texels.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_occlusion_held_out_trace(alpi_occlusion_held_out *held_out, uint32_t before,
                                         uint32_t samples, const alpi_task_progress *progress);

#endif
