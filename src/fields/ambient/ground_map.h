// SPDX-License-Identifier: MIT
// The ground map: light that leaves the surfaces which are seen from above.
#ifndef ALPI_FIELDS_GROUND_MAP_H
#define ALPI_FIELDS_GROUND_MAP_H

#include "fields/truth.h"

enum { ALPI_GROUND_SIDE = ALP_GROUND_MAP_SIDE };

/// Radiosity B = ρE + πLe [W·m⁻²] of the first front side below the top of the scene. Texels that
/// see none hold 0.
typedef struct alpi_ground_map {
    float low[2], scale[2]; // column = (x − low[0]) scale[0], row = (z − low[1]) scale[1]
    float texels[ALPI_GROUND_SIDE * ALPI_GROUND_SIDE][3];
} alpi_ground_map;

/// @param options of the reference; its samples are those of each texel
/// @return ALP_OK; UNSUPPORTED; OUT_OF_MEMORY; CANCELLED
alp_result alpi_ground_map_make(const alp_scene *scene, const alp_reference_options *options,
                                alpi_ground_map *map);

/// Bilinear; positions beyond the bounds read the nearest texel.
void alpi_ground_map_read(const alpi_ground_map *map, float x, float z, float radiosity[3]);

#endif
