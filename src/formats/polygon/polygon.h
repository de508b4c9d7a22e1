// SPDX-License-Identifier: MIT
// Faces of more than three corners, also concave ones and such with holes, cut into triangles.
#ifndef ALPI_FORMATS_POLYGON_H
#define ALPI_FORMATS_POLYGON_H

#include "base/context.h"

/// Memory that is kept from one face to the next. Start with {.context = context}.
typedef struct alpi_polygon_scratch {
    alp_context *context;
    void *memory;
    size_t size;
    uint64_t work;        // steps that cutting has taken so far
    uint64_t bridge_work; // looks at corners for which joining holes was charged so far
} alpi_polygon_scratch;
void alpi_polygon_scratch_destroy(alpi_polygon_scratch *scratch);

/// Corners of all rings one after the other: first the outline, then the holes. A hole may turn
/// either way. Every ring has three corners or more.
typedef struct alpi_polygon_rings {
    const float (*points)[3];
    const uint32_t *ends; // [count] one past the last corner of each
    uint32_t count;
} alpi_polygon_rings;

/// Corners of the outline + 2 for each hole and its corners − 2: without loss, corners that lie on
/// a line included.
uint32_t alpi_polygon_triangle_count(const alpi_polygon_rings *polygon);

/// Cuts a polygon into triangles that turn as the outline does and name corners by their place in
/// `points`. The plane is Newell's of the outline; corners need not lie in it, and what is not
/// finite counts as 0. A convex face is a fan about its first corner, four corners are cut along
/// the diagonal that leaves two triangles turning the same way. Of a flat face without crossing
/// edges the areas sum to its own, and without holes no triangle is without area unless all are.
/// Where edges cross or a hole lies outside, triangles overlap or turn over and *clean is false.
///
/// Steps grow about as n^1.5 for n corners half of which are dents; they end at 2048 a corner,
/// whatever the face, with what is left cut as a fan and *clean false. Holes take h · n looks for
/// h holes, charged to the scratch: 2^30 in all, then LIMIT.
/// @param triangles [alpi_polygon_triangle_count]
/// @return ALP_OK; LIMIT (holes × corners); OUT_OF_MEMORY
alp_result alpi_polygon_triangulate_rings(alpi_polygon_scratch *scratch,
                                          const alpi_polygon_rings *polygon,
                                          uint32_t (*triangles)[3], bool *clean);

/// The same for a face of one ring: `count` ≥ 3 corners become count − 2 triangles.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_polygon_triangulate(alpi_polygon_scratch *scratch, uint32_t count,
                                    const float (*corners)[3], uint32_t (*triangles)[3],
                                    bool *clean);

#endif
