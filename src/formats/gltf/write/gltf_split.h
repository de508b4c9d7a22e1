// SPDX-License-Identifier: MIT
// Vertices that chart borders part.
#ifndef ALPI_FORMATS_GLTF_SPLIT_H
#define ALPI_FORMATS_GLTF_SPLIT_H

#include "base/context.h"

enum { ALPI_GLTF_SPLIT_WIDTH = 6 };

typedef struct alpi_gltf_split_input {
    uint32_t vertex_count, triangle_count;
    uint32_t (*indices)[3]; // of the primitive, in file order
    uint32_t width;         // values of a corner, at most ALPI_GLTF_SPLIT_WIDTH
    const float *values;    // [triangle_count][3][width]
    const bool *usable;     // [triangle_count] triangles without area part no vertices
} alpi_gltf_split_input;

/// Vertices such that each has one bake coordinate, or one of each set.
typedef struct alpi_gltf_split {
    bool changed; // false: the vertices are the old ones and so are the indices
    uint32_t vertex_count;
    uint32_t *sources;      // [vertex_count] old vertex of each
    float *values;          // [vertex_count][width]
    uint32_t (*indices)[3]; // [triangle_count]
} alpi_gltf_split;

alp_result alpi_gltf_split_create(alp_context *context, const alpi_gltf_split_input *input,
                                  alpi_gltf_split *split);
void alpi_gltf_split_destroy(alp_context *context, alpi_gltf_split *split);

#endif
