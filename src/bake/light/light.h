// SPDX-License-Identifier: MIT
// The light of a bake. Start with light.c.
#ifndef ALPI_BAKE_LIGHT_H
#define ALPI_BAKE_LIGHT_H

#include "bake/light/light_state.h"

/// The stage of light: gathers irradiance at the texels, if a map needs it, and fills the report.
/// @return ALP_OK; LIMIT: the time was over before any texel had light; OUT_OF_MEMORY; CANCELLED
alp_result alpi_bake_light(alpi_bake_job *job);

/// Radiosity, final gather and rounds: fills light->values and the report.
/// @param light its settings and sources are chosen here
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_radiosity(alpi_light_bake *light);

#endif
