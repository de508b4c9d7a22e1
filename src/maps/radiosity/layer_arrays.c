// SPDX-License-Identifier: MIT
#include "maps/radiosity/layer_arrays.h"

#include "base/memory.h"

alp_result alpi_layer_arrays_reserve(alpi_layer_arrays *layers, size_t sided_texels,
                                     size_t sided_patches, size_t texels)
{
    for (uint32_t i = 0; i < layers->count; i++) {
        ALPI_TRY_NEW(layers->context, layers->direct[i], sided_texels);
        ALPI_TRY_NEW(layers->context, layers->before[i], sided_patches);
        ALPI_TRY_NEW(layers->context, layers->bounced[i], texels);
    }
    return ALP_OK;
}

void alpi_layer_arrays_clear(alpi_layer_arrays *layers)
{
    for (uint32_t i = 0; i < layers->count; i++) {
        alpi_release(layers->context, layers->direct[i]);
        alpi_release(layers->context, layers->before[i]);
        alpi_release(layers->context, layers->bounced[i]);
        layers->direct[i] = layers->before[i] = layers->bounced[i] = NULL;
    }
}
