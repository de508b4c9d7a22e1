// SPDX-License-Identifier: MIT
// The solution that texels gather from: direct light, patches, bounce passes.
#ifndef ALPI_BAKE_LIGHT_SOLVE_H
#define ALPI_BAKE_LIGHT_SOLVE_H

#include "bake/light/light_state.h"
#include "maps/radiosity/solution.h"

/// A radiosity on the atlas of the map; or on an atlas of the whole scene, if some surfaces are
/// baked alone (--only).
typedef struct alpi_light_solution {
    alpi_radiosity own;
    alpi_solution *whole_scene; // or NULL
    alpi_radiosity *radiosity;  // one of the two; NULL: none yet
} alpi_light_solution;

/// Solves, and fills the report.
/// @param solution zeroed; cleared by alpi_light_solution_clear in any case
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_solve(alpi_light_bake *light, const alpi_light_gatherers *gatherers,
                            alpi_light_solution *solution);
void alpi_light_solution_clear(alpi_light_solution *solution);

#endif
