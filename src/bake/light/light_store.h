// SPDX-License-Identifier: MIT
// The light of a bake as its map holds it.
#ifndef ALPI_BAKE_LIGHT_STORE_H
#define ALPI_BAKE_LIGHT_STORE_H

#include "bake/light/light_state.h"

/// Joins direct and bounced light, their variances and their layers, after the rounds. Keeps both
/// apart too, if maps of them are wanted.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_light_finish(alpi_light_bake *light, const alpi_light_rounds *rounds);
/// Stores irradiance and standard errors in the job, and states the error of the map. Hemicubes
/// state none.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_store(alpi_light_bake *light);

#endif
