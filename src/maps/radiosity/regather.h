// SPDX-License-Identifier: MIT
// Repeats a final gather for other light on the same surfaces, such as that of a layer. The same
// rays trace the same texels, and the same stencils interpolate the others. Nothing depends on the
// light, so the result is linear in it, except that negative interpolated values become 0.
#ifndef ALPI_MAPS_REGATHER_H
#define ALPI_MAPS_REGATHER_H

#include "maps/radiosity/final_gather.h"
#include "transport/gather/kept_rays.h"

typedef struct alpi_regather {
    alpi_final_gather_options options; // its gather job measures no sky
    alpi_lattice lattice;              // its values are zeros
    uint32_t *list;                    // [traced]
    uint32_t traced;
    alpi_kept_rays kept; // of no receivers: rays are traced again each time
    uint64_t rays;       // traced so far
} alpi_regather;

/// @param states     [texels] of alpi_final_gather; borrowed, as all else
/// @param kept_limit bytes of kept rays, within the budget
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_regather_create(const alpi_final_gather_options *options,
                                const alpi_lattice *lattice, uint8_t *states, uint64_t kept_limit,
                                const alpi_task_progress *progress, alpi_regather *regather);
void alpi_regather_destroy(alpi_regather *regather);

/// Writes the means of the gather job's values for the light that is in the cells.
/// @return ALP_OK; CANCELLED
alp_result alpi_regather_run(alpi_regather *regather, const alpi_task_progress *progress);

#endif
