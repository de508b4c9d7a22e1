// SPDX-License-Identifier: MIT
// The different bake coordinates of a geometry, and which of them each corner has.
#ifndef ALPI_FORMATS_COLLADA_PATCH_UVS_H
#define ALPI_FORMATS_COLLADA_PATCH_UVS_H

#include "formats/collada/write/collada_patch.h"

/// Different coordinates of a geometry.
typedef struct alpi_collada_uvs {
    float (*uvs)[2 * ALPI_COLLADA_SETS]; // those of sets that are not there are 0
    uint32_t *slots;                     // [size] index, ALPI_NONE = free
    uint32_t count;
    size_t size;
} alpi_collada_uvs;

/// Coordinates of a primitive's corners, as indices into those of its geometry.
typedef struct alpi_collada_corners {
    uint32_t (*of_triangle)[3]; // [triangle_count]
    uint32_t *of_corner;        // [corner_count] the same where all triangles agree
    bool agreed;
} alpi_collada_corners;

/// Sets of coordinates that are written: more than one where they are blended.
uint32_t alpi_collada_count_sets(const alpi_collada_patcher *p);

/// Room for the coordinates of so many corners of triangles. To be destroyed even after a failure.
alp_result alpi_collada_uvs_create(alp_context *context, uint64_t corner_count,
                                   alpi_collada_uvs *pool);
void alpi_collada_uvs_destroy(alp_context *context, alpi_collada_uvs *pool);

/// Coordinates of all corners of a surface, of which new ones go into the pool; a triangle without
/// area takes what its neighbours give. To be destroyed even after a failure.
alp_result alpi_collada_corners_create(const alpi_collada_patcher *p, alpi_collada_uvs *pool,
                                       uint32_t surface, const alpi_collada_faces *faces,
                                       alpi_collada_corners *corners);
void alpi_collada_corners_destroy(alp_context *context, alpi_collada_corners *corners);

#endif
