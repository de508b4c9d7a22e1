// SPDX-License-Identifier: MIT
// Jumps: places of a seam where light itself differs across the edge, though no ray found a wall.
#ifndef ALPI_MAPS_JUMPS_H
#define ALPI_MAPS_JUMPS_H

#include "maps/seams/seams.h"

/// Finds the samples at which the sides differ by more than
/// - 6 standard errors of the difference,
/// - 8 times the median difference along the seam between the same two charts, and
/// - 4 times as much as either side changes within two texels along the seam. A shadow that crosses
///   the seam changes both sides there, and is no jump.
/// Pairs of edges shorter than four texels are too short to be judged.
/// @param pages  of the map   @param errors [seams->pixel_count] standard errors, 0 of gaps
/// @param least  the smallest standard error that counts
/// @param jumps  out: [seams->sample_count] 1: a jump
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_jumps_find(const alp_lightmap *lightmap, const alpi_seams *seams,
                           float *const *pages, const float *errors, double least, uint8_t *jumps);

#endif
