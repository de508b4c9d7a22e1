// SPDX-License-Identifier: MIT
// How near a ray has to meet a patch for one light all over it to be too coarse.
#ifndef ALPI_MAPS_PATCH_REACH_H
#define ALPI_MAPS_PATCH_REACH_H

#include "base/tasks.h"
#include "maps/radiosity/patches.h"

/// Sets the sides that cells tell (ALPI_CELL_SIDE) by the light in them now: those of their texels,
/// and longer where neighbours' light differs. From a distance d a cell of side h is seen under
/// (h/d)², and what is seen of it shifts by about h/d of its side: where light changes by ΔL across
/// it, that errs by ΔL (h/d)³, so for one error d grows with the cube root of ΔL.
/// @return ALP_OK; CANCELLED
alp_result alpi_patches_set_reach(const alpi_patches *patches, const alpi_task_progress *progress);

#endif
