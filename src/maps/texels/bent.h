// SPDX-License-Identifier: MIT
// Bent normals at the texels of an occlusion map: the mean open direction.
//
//     normalised (1/π) ∫ (1 − w) ω (n·ω) dω
//
// They come from the rays of occlusion. A ray of random length is free with probability 1 − w, so
// the expected sum of the free directions is this integral.
// Based on: H. Landis. Production-Ready Global Illumination. SIGGRAPH 2002 course 16.
#ifndef ALPI_MAPS_BENT_H
#define ALPI_MAPS_BENT_H

#include "base/tasks.h"
#include "maps/texels/lattice.h"
#include "transport/occlusion/occlusion.h"

/// Computes unit vectors in world space for the texels in `order` whose state is not OPEN. The sums
/// of traced texels are interpolated by the stencils, and normalised last. A texel with nothing
/// open takes its shading normal.
/// @param progress NULL, or a callback that may cancel
/// @param bent     [texels] out; other texels keep theirs
/// @return ALP_OK; CANCELLED
alp_result alpi_bent_normals(const alpi_lattice *lattice, const alpi_occlusion_sums *sums,
                             const uint32_t *order, uint32_t order_count,
                             const alpi_task_progress *progress, float (*bent)[3]);

#endif
