// SPDX-License-Identifier: MIT
// Variances of a map, pooled over neighbours. A texel's own few replicates give a variance that is
// often far off, and sometimes 0.
#ifndef ALPI_MAPS_POOLED_VARIANCE_H
#define ALPI_MAPS_POOLED_VARIANCE_H

#include "maps/texels/lattice.h"
#include "transport/paths/reference.h"

/// Replaces the variance of each traced texel by the mean over the traced texels of its chart among
/// the 3 × 3 around it.
/// @param values [texels] variances of those traced, in and out
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED by the watch of the context
/// Cost: 12 bytes a texel while it runs.
alp_result alpi_pool_variances(const alpi_lattice *lattice, alpi_reference_value *values);

#endif
