// SPDX-License-Identifier: MIT
// Reach of cells: the distance below which a hit is too near to read one value for a whole texel.
#ifndef ALPI_MAPS_PATCH_REACH_H
#define ALPI_MAPS_PATCH_REACH_H

#include "base/tasks.h"
#include "maps/radiosity/patches.h"

/// Sets ALPI_CELL_SIDE of all cells by their light: the side of their texel, longer where
/// neighbours differ. A cell of side h at distance d covers (h/d)² of the view, and its visible
/// part shifts by h/d. If light changes by ΔL across the cell, the error is ΔL (h/d)³. For a
/// constant error, d grows with the cube root of ΔL.
/// @return ALP_OK; CANCELLED
alp_result alpi_patches_set_reach(const alpi_patches *patches, const alpi_task_progress *progress);

#endif
