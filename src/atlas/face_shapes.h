// SPDX-License-Identifier: MIT
// What the places of a face's texels share, kept where texels are many to a face.
#ifndef ALPI_ATLAS_FACE_SHAPES_H
#define ALPI_ATLAS_FACE_SHAPES_H

#include "atlas/clip.h"

/// Of texels that lie wholly in the face both; of others the facets of their middles and pieces.
typedef struct alpi_face_shape {
    alpi_page_map map;
    alpi_facet facet; // with its lift
} alpi_face_shape;

enum { ALPI_TEXELS_PER_FACE_SHAPE = 16 };
_Static_assert(sizeof(alpi_face_shape) <= 16 * (int)ALPI_TEXELS_PER_FACE_SHAPE,
               "16 bytes a texel at most");

/// Makes the shapes of all faces where there are so many texels to a face; else none.
/// @return ALP_OK; OUT_OF_MEMORY: the texels own what was made
alp_result alpi_face_shapes_make(alpi_texels *texels);

#endif
