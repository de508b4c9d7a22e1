// SPDX-License-Identifier: MIT
// Interpolation of gathered light by the stencils of the lattice.
#ifndef ALPI_MAPS_STENCIL_LIGHT_H
#define ALPI_MAPS_STENCIL_LIGHT_H

#include "maps/texels/lattice.h"
#include "transport/gather/gather.h"

/// Interpolates the means of a texel, at least 0, and the sky's part of them.
void alpi_stencil_light(const alpi_gather_job *gather, uint32_t texel, const alpi_stencil *stencil);
/// Interpolates gather->directional, unless NULL.
void alpi_stencil_directional(const alpi_gather_job *gather, uint32_t texel,
                              const alpi_stencil *stencil);

#endif
