// SPDX-License-Identifier: MIT
// The steps of alpi_patches_create, in order.
#ifndef ALPI_MAPS_PATCH_CREATE_H
#define ALPI_MAPS_PATCH_CREATE_H

#include "maps/radiosity/patches.h"

enum { ALPI_PATCH_TEXEL_LIMIT = ALPI_PATCH_SIDE * ALPI_PATCH_SIDE };

/// Groups all texels whose `patch_of` is not ALPI_NONE into patches, and numbers them.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_patches_split(alpi_patches *patches);
/// Makes `triangles`, and fills `places` (all ones before) and `chart_texels` (ALPI_NONE before).
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_patch_places_create(alpi_patches *patches);
/// Fills `reflectances`, `emissions` and the sides of the cells.
/// @return ALP_OK; CANCELLED
alp_result alpi_patches_measure_materials(alpi_patches *patches);

#endif
