// SPDX-License-Identifier: MIT
// Direct light of texels: gathered on a chequerboard, and between where that does not tell it.
#ifndef ALPI_MAPS_DIRECT_MAP_H
#define ALPI_MAPS_DIRECT_MAP_H

#include "maps/radiosity/radiosity.h"

/// Which texels may be interpolated.
typedef struct alpi_direct_map_options {
    const alpi_lattice *lattice; // its grid and texels; states and values stay as they are
    const uint8_t *near;         // [texels] alpi_nearness, or NULL
    double error;                // of the map, relative, as it is wanted; 0: all texels gather
    bool backs;                  // the list is of backs, texels plus their number
} alpi_direct_map_options;

/// Gathers direct light E₀ [W·m⁻²] of listed texels by the first samples of a solution: of those
/// whose x + y is even, and of the others where it bends or steps too much between the four beside
/// them, another surface touches them, or one is missing along both axes. The rest are means of
/// these four, or of two along a border, which state the variance of that and, squared, how much
/// light bends there. With error ε and E the mean of direct light, too much is a bend
/// (alpi_stencil) of more than ε E / 4 in the mean of the channels, or a spread of more than √ε E:
/// what is smooth spreads by the root of what it bends, and half a spread is the most that an edge
/// between two texels errs. What no texel of the board is touched by, or no sample of theirs finds,
/// is missed. Of backs, E is that of the list, and what touches is that of the fronts.
/// @param output as of alpi_radiosity_direct
/// @return texels that gathered in *gathered; ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_direct_map(const alpi_radiosity *radiosity, const alpi_direct_map_options *options,
                           const uint32_t *list, uint32_t count, const alpi_task_progress *progress,
                           alpi_direct_output *output, uint32_t *gathered);

#endif
