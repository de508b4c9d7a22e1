// SPDX-License-Identifier: MIT
#include "maps/radiosity/light_layers.h"

#include "base/memory.h"

alp_result alpi_light_layers_reserve(alpi_light_layers *layers, size_t sided_texels,
                                     size_t sided_blocks, size_t texels)
{
    for (uint32_t i = 0; i < layers->count; i++) {
        ALPI_TRY_NEW(layers->context, layers->direct[i], sided_texels);
        ALPI_TRY_NEW(layers->context, layers->before[i], sided_blocks);
        ALPI_TRY_NEW(layers->context, layers->bounced[i], texels);
    }
    return ALP_OK;
}

void alpi_light_layers_clear(alpi_light_layers *layers)
{
    for (uint32_t i = 0; i < layers->count; i++) {
        alpi_release(layers->context, layers->direct[i]);
        alpi_release(layers->context, layers->before[i]);
        alpi_release(layers->context, layers->bounced[i]);
        layers->direct[i] = layers->before[i] = layers->bounced[i] = NULL;
    }
}
