// SPDX-License-Identifier: MIT
// The plan of layers, and their pages. light/light_layers.c gathers their light.
#ifndef ALPI_BAKE_LAYER_PLAN_H
#define ALPI_BAKE_LAYER_PLAN_H

#include "bake/job.h"

/// Finds and names the layers, if they are asked for. Warns where lights share a layer.
alp_result alpi_bake_plan_layers(alpi_bake_job *job);
/// The same without the warning. @param lights out: number of lights, 0 without layers
alp_result alpi_bake_find_layers(alpi_bake_job *job, uint32_t *lights);
void alpi_bake_release_layers(alpi_bake_job *job);

/// Moves the layers to pages of the lightmap.
alp_result alpi_bake_store_layers(alpi_bake_job *job);

#endif
