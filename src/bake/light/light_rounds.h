// SPDX-License-Identifier: MIT
// Rounds of samples and rays, until the wanted error is stated or the time is over.
#ifndef ALPI_BAKE_LIGHT_ROUNDS_H
#define ALPI_BAKE_LIGHT_ROUNDS_H

#include "bake/light/light_state.h"

/// Gathers bounced light into rounds->light->values, and adds samples to the solution's direct
/// light. Without rounds: once.
/// @param rounds with light, solution and fixed; cleared by alpi_light_rounds_clear in any case
/// @return ALP_OK, also if later rounds were cut off; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_run_rounds(alpi_light_rounds *rounds);
/// Releases all but the skies.
void alpi_light_rounds_trim(alpi_light_rounds *rounds);
void alpi_light_rounds_clear(alpi_light_rounds *rounds);

#endif
