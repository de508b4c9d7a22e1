// SPDX-License-Identifier: MIT
// The light of each layer: all lights but its own are off. Layers trace the same rays as the whole
// light, so that they add up to it.
#ifndef ALPI_BAKE_LIGHT_LAYERS_H
#define ALPI_BAKE_LIGHT_LAYERS_H

#include "bake/light/light_state.h"

/// The layers that a solution fills; NULL: none are wanted.
/// @param sky whether bounced rays gather the sky too
alpi_layer_arrays *alpi_light_start_layers(alpi_bake_job *job, bool sky);
/// Gathers each layer at the texels with the rays of the whole light, and averages it with the
/// rounds before.
/// @param rays of each texel now
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_gather_layers(alpi_light_rounds *rounds,
                                    const alpi_final_gather_options *options, uint8_t *states,
                                    uint32_t rays);
/// Scales the direct light of each layer at listed texels, around more samples. The samples are
/// added to `had / more` times the mean before; then the sum is scaled to the mean.
/// @param merged false: before the samples; true: after them
void alpi_light_scale_layers(const alpi_light_rounds *rounds, const uint32_t *list, uint32_t count,
                             uint32_t more, bool merged);
/// Adds direct light to each layer. The mean of each value becomes the sum of the layers, as floats
/// in their order.
/// @param skies  [texels] or NULL: a soft sky's part of the bounced light
/// @param direct whether the map holds direct light
void alpi_light_sum_layers(const alpi_light_bake *light, const float (*skies)[3], bool direct);

#endif
