// SPDX-License-Identifier: MIT
// Light of each layer on its own: what a radiosity keeps of lights that are told apart. Light is
// linear in what makes it, so that layers that see the same rays add up to the whole.
#ifndef ALPI_MAPS_LIGHT_LAYERS_H
#define ALPI_MAPS_LIGHT_LAYERS_H

#include "base/context.h"

enum { ALPI_LAYER_LIMIT = 16 };

typedef struct alpi_light_layers {
    alp_context *context;
    uint32_t count;
    const uint32_t *part_layers; // [parts of direct light] the layer of each; borrowed
    uint32_t sky; // the layer of a sky that is gathered with what is bounced; ALPI_NONE: none is
    float (*direct[ALPI_LAYER_LIMIT])[3];  // [sides × texels] E₀, such a sky apart
    float (*before[ALPI_LAYER_LIMIT])[3];  // [sides × blocks] E of the last pass but one
    float (*bounced[ALPI_LAYER_LIMIT])[3]; // [texels] what the last bounce brings to them
} alpi_light_layers;

/// Makes room, all zero. @return ALP_OK; OUT_OF_MEMORY: what there is goes with _clear
alp_result alpi_light_layers_reserve(alpi_light_layers *layers, size_t sided_texels,
                                     size_t sided_blocks, size_t texels);
void alpi_light_layers_clear(alpi_light_layers *layers);

#endif
