// SPDX-License-Identifier: MIT
// Layers of light: which there are, what each gets, and where it goes.
#ifndef ALPI_BAKE_LAYERS_H
#define ALPI_BAKE_LAYERS_H

#include "bake/job.h"
#include "base/file.h"
#include "maps/radiosity/bounced_map.h"
#include "maps/radiosity/radiosity.h"

/// Refuses what has no layers.
alp_result alpi_bake_check_layers(const alpi_bake_job *job);
/// Finds out which layers there are, and names them, if they are asked for.
alp_result alpi_bake_plan_layers(alpi_bake_job *job);
/// The same without a warning of too many. @param lights out: that there are, 0 without layers
alp_result alpi_bake_find_layers(alpi_bake_job *job, uint32_t *lights);
void alpi_bake_release_layers(alpi_bake_job *job);

/// Where a solution keeps them, NULL: they are not asked for.
/// @param sky whether the sky is gathered with what is bounced
alpi_light_layers *alpi_bake_light_layers(alpi_bake_job *job, bool sky);
/// What texels gather of each by the rays that found all of it, as options and states say; averaged
/// with what they gathered before.
/// @param had  [texels] rays of each before, or NULL: none
/// @param rays of each now
alp_result alpi_bake_gather_layers(alpi_bake_job *job, const alpi_radiosity *solution,
                                   const alpi_bounced_options *options, const alpi_lattice *lattice,
                                   uint8_t *states, const uint32_t *had, uint32_t rays,
                                   const alpi_task_progress *progress);
/// Puts each together, and makes their sum, as floats in their order, the mean of the values.
/// @param skies  [texels] or NULL: what of the light is a sky's that is gathered with what bounces
/// @param direct whether direct light counts
void alpi_bake_sum_layers(const alpi_bake_job *job, const uint32_t *order, uint32_t count,
                          const float (*skies)[3], bool direct, alpi_reference_value *values);
/// Stores them in the lightmap.
alp_result alpi_bake_store_layers(alpi_bake_job *job);

/// Fails if a file of theirs could not be written.
alp_result alpi_bake_check_layer_files(const alpi_bake_job *job, uint32_t pages);
/// Their files of the maps folder.
alp_result alpi_bake_add_layers(const alpi_bake_job *job, alpi_file_set *files);

#endif
