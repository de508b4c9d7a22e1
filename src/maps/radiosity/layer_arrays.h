// SPDX-License-Identifier: MIT
// Light of each layer. Light is linear in its sources, so layers of the same rays add up to the
// whole.
#ifndef ALPI_MAPS_LAYER_ARRAYS_H
#define ALPI_MAPS_LAYER_ARRAYS_H

#include "base/context.h"

enum { ALPI_LAYER_LIMIT = 16 };

typedef struct alpi_layer_arrays {
    alp_context *context;
    uint32_t count;
    const uint32_t *part_layers; // [parts of direct light] the layer of each; borrowed
    uint32_t sky; // layer of a sky that is gathered with bounced light; ALPI_NONE: none
    float (*direct[ALPI_LAYER_LIMIT])[3];  // [sides × texels] E₀ without such a sky
    float (*before[ALPI_LAYER_LIMIT])[3];  // [sides × patches] E of the last pass but one
    float (*bounced[ALPI_LAYER_LIMIT])[3]; // [texels] E of the last bounce, gathered by texels
} alpi_layer_arrays;

/// Allocates all arrays, zeroed. @return ALP_OK; OUT_OF_MEMORY: alpi_layer_arrays_clear frees the
/// rest
alp_result alpi_layer_arrays_reserve(alpi_layer_arrays *layers, size_t sided_texels,
                                     size_t sided_patches, size_t texels);
void alpi_layer_arrays_clear(alpi_layer_arrays *layers);

#endif
