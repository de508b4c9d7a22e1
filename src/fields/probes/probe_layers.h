// SPDX-License-Identifier: MIT
// Light of each lamp and sun apart, in probes.
#ifndef ALPI_FIELDS_PROBE_LAYERS_H
#define ALPI_FIELDS_PROBE_LAYERS_H

#include "fields/probes/probes.h"
#include "maps/radiosity/layer_arrays.h"

enum { ALPI_LAMP_LAYER_LIMIT = ALPI_LAYER_LIMIT - 1 }; // the last holds all other light

typedef struct alpi_probe_layers {
    alpi_layer_arrays light; // as a radiosity solves them
    uint32_t *part_layers;
    uint32_t count;                        // of lamps
    uint32_t lamps[ALPI_LAMP_LAYER_LIMIT]; // the light of each in the lighting
} alpi_probe_layers;

/// Plans a layer for each lamp and sun that shines, and one for all other light.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_probe_layers_plan(const alp_scene *scene, const alpi_lighting *lighting,
                                  alpi_probe_layers *layers);
void alpi_probe_layers_clear(alp_context *context, alpi_probe_layers *layers);

/// Names the layers of a volume whose arrays are there. @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_probe_layers_name(const alpi_lighting *lighting, const alpi_probe_layers *layers,
                                  alpi_probe_volume *volume);

#endif
