// SPDX-License-Identifier: MIT
// Layers of light: their plan, the light that each gathers, and their pages.
#ifndef ALPI_BAKE_LAYERS_H
#define ALPI_BAKE_LAYERS_H

#include "bake/job.h"
#include "maps/radiosity/final_gather.h"
#include "maps/radiosity/radiosity.h"

/// Finds and names the layers, if they are asked for. Warns where lights share a layer.
alp_result alpi_bake_plan_layers(alpi_bake_job *job);
/// The same without the warning. @param lights out: number of lights, 0 without layers
alp_result alpi_bake_find_layers(alpi_bake_job *job, uint32_t *lights);
void alpi_bake_release_layers(alpi_bake_job *job);

/// The layers as a solution fills them; NULL: they are not asked for.
/// @param sky whether bounced rays gather the sky too
alpi_layer_arrays *alpi_bake_light_layers(alpi_bake_job *job, bool sky);
/// Gathers each layer at the texels by the rays that found the whole light, as options and states
/// say. Averages it with the light that was gathered before.
/// @param had  [texels] rays of each texel before, or NULL: none
/// @param rays of each texel now
alp_result alpi_bake_gather_layers(alpi_bake_job *job, const alpi_radiosity *solution,
                                   const alpi_final_gather_options *options,
                                   const alpi_lattice *lattice, uint8_t *states,
                                   const uint32_t *had, uint32_t rays,
                                   const alpi_task_progress *progress);
/// Completes each layer. The mean of each value becomes the sum of the layers, as floats in their
/// order.
/// @param skies  [texels] or NULL: the part of the light that bounced rays found in the sky
/// @param direct whether direct light counts
void alpi_bake_sum_layers(const alpi_bake_job *job, const uint32_t *order, uint32_t count,
                          const float (*skies)[3], bool direct, alpi_reference_value *values);
/// Moves the layers to pages of the lightmap.
alp_result alpi_bake_store_layers(alpi_bake_job *job);

#endif
