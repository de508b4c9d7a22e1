// SPDX-License-Identifier: MIT
// Variances of a map, each the mean over a texel and its neighbours: of a few replicates alone one
// would be anything, and by chance nothing.
#ifndef ALPI_MAPS_POOLED_VARIANCE_H
#define ALPI_MAPS_POOLED_VARIANCE_H

#include "maps/texels/lattice.h"
#include "transport/paths/reference.h"

/// Puts in the place of each traced texel's variance the mean over the traced texels of its chart
/// in the three by three about it. Works in bands of rows, and takes memory for the pooled ones of
/// a band alone.
/// @param values [texels] variances of those traced, in and out
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED by who watches the context
alp_result alpi_pool_variances(const alpi_lattice *lattice, alpi_reference_value *values);

#endif
