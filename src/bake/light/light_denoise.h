// SPDX-License-Identifier: MIT
// The denoiser of bounced light.
#ifndef ALPI_BAKE_LIGHT_DENOISE_H
#define ALPI_BAKE_LIGHT_DENOISE_H

#include "bake/light/light_state.h"

/// Filters the noise of light->values. The sky's part keeps its share. A bake that ends before or
/// meanwhile, and keeps its values, has the light as it was gathered: no texel changes before all
/// are filtered.
/// @param skies [texels] a soft sky's part of the values, or NULL
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_denoise(const alpi_light_bake *light, float (*skies)[3]);

#endif
