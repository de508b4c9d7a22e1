// SPDX-License-Identifier: MIT
// Faces of more than three corners, also concave ones, cut into triangles.
#ifndef ALPI_FORMATS_POLYGON_H
#define ALPI_FORMATS_POLYGON_H

#include "base/context.h"

/// Memory that is kept from one face to the next. Start with {.context = context}.
typedef struct alpi_polygon_scratch {
    alp_context *context;
    void *memory;
    size_t size;
    uint64_t work; // steps that cutting has taken so far
} alpi_polygon_scratch;
void alpi_polygon_scratch_destroy(alpi_polygon_scratch *scratch);

/// Cuts a face of `count` ≥ 3 corners into count − 2 triangles of its corners, wound as it is. A
/// convex face is a fan about its first corner; of a flat face without crossing edges the areas
/// sum to its own, and no triangle is without area unless all are. Where edges cross, triangles
/// overlap or turn over; where no ear is found for it (or the face is so large and contrived that
/// looking would not end in time), what is left becomes a fan and *clean is false. Steps grow
/// about as count^1.5 where half of the corners are dents, and end at 2048 a corner.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_polygon_triangulate(alpi_polygon_scratch *scratch, uint32_t count,
                                    const float (*corners)[3], uint32_t (*triangles)[3],
                                    bool *clean);

#endif
