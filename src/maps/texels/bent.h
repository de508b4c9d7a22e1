// SPDX-License-Identifier: MIT
// Bent normals at the texels of an occlusion map: the mean open direction.
//
//     normalised (1/π) ∫ (1 − w) ω (n·ω) dω
//
// They come from the same rays as the occlusion: a ray of random length is free with the chance
// 1 − w, so the sum of the free directions has the wanted expectation.
// Based on: H. Landis. Production-Ready Global Illumination. SIGGRAPH 2002 course 16.
#ifndef ALPI_MAPS_BENT_H
#define ALPI_MAPS_BENT_H

#include "base/tasks.h"
#include "maps/texels/lattice.h"
#include "transport/occlusion/occlusion.h"

/// Unit vectors, world space, for the texels in `order` whose state is not OPEN: of those traced by
/// their sums; of those interpolated by the sums that their stencils weigh, normalised after. Where
/// nothing is open, the shading normal.
/// @param progress NULL, or who is asked whether to go on
/// @param bent     [texels] out; other texels stay
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_bent_normals(const alpi_lattice *lattice, const alpi_occlusion_sums *sums,
                             const uint32_t *order, uint32_t order_count,
                             const alpi_task_progress *progress, float (*bent)[3]);

#endif
