// SPDX-License-Identifier: MIT
// How rays find the patches that they meet. alpi_patches_find and alpi_patches_light of patches.h
// are of this room too.
#ifndef ALPI_MAPS_PATCH_LOOKUP_H
#define ALPI_MAPS_PATCH_LOOKUP_H

#include "maps/patches.h"

/// Makes `triangles`, and fills `places` (all ones before) and `chart_texels` (ALPI_NONE before),
/// of patches whose `blocks` say which texels have light of their own.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_patch_places_create(alpi_patches *patches);

#endif
