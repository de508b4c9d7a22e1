// SPDX-License-Identifier: MIT
// Which texels are traced, and which are interpolated.
#ifndef ALPI_BAKE_OCCLUSION_LATTICE_H
#define ALPI_BAKE_OCCLUSION_LATTICE_H

#include "bake/occlusion/occlusion_state.h"

/// Traces every texel that has no rays yet.
alp_result alpi_occlusion_trace_all(alpi_occlusion_state *state);
/// Traces the lattice, and texels between whose neighbours disagree. Interpolates the others.
alp_result alpi_occlusion_trace_lattice(alpi_occlusion_state *state);
/// Interpolates texels without a value from any neighbours they have.
alp_result alpi_occlusion_fill_gaps(alpi_occlusion_state *state);

#endif
