// SPDX-License-Identifier: MIT
// Polygons with holes → triangles whose signed areas add up to the polygon's.
#ifndef ALPI_FORMATS_COLLADA_POLYGON_H
#define ALPI_FORMATS_COLLADA_POLYGON_H

#include "base/context.h"

/// Corners of all rings one after the other: first the outline, then the holes. A hole may turn
/// either way. Every ring has three corners or more.
typedef struct alpi_ear_polygon {
    const float (*points)[3];
    const uint32_t *ring_ends; // [ring_count] one past the last corner of each
    uint32_t ring_count;
} alpi_ear_polygon;

/// Memory that polygons are cut in, one after the other.
typedef struct alpi_ear_cutter {
    alp_context *context;
    struct alpi_ear_corner *corners; // [corner_capacity]
    size_t corner_capacity;
    uint32_t *queue, *cells, *members;
    size_t queue_capacity, cell_capacity, member_capacity;
} alpi_ear_cutter;

void alpi_ear_cutter_destroy(alpi_ear_cutter *cutter);

/// Corners of the outline + 2 for each hole and its corners − 2: without loss, corners that lie on
/// a line included.
uint32_t alpi_ear_triangle_count(const alpi_ear_polygon *polygon);

/// Cuts ears off; triangles turn as the outline does and name corners by their place in `points`.
/// Corners need not lie in one plane; the plane is Newell's. A polygon that crosses itself gets
/// triangles too, which overlap: then *tidy is false. O(n log n) in practice, bounded by O(n).
/// @param triangles [alpi_ear_triangle_count]
/// @return ALP_OK; LIMIT (holes × corners); OUT_OF_MEMORY
alp_result alpi_ear_triangulate(alpi_ear_cutter *cutter, const alpi_ear_polygon *polygon,
                                uint32_t (*triangles)[3], bool *tidy);

#endif
