// SPDX-License-Identifier: MIT
// Are the triangles small enough for what lies on them? The interpolant of values at vertices,
// held against accessibility asked for at points inside of the triangles.
#ifndef ALPI_MAPS_VERTEX_DETAIL_H
#define ALPI_MAPS_VERTEX_DETAIL_H

#include "maps/vertex/vertex_map.h"
#include "transport/occlusion/occlusion.h"

/// What was found on one surface.
typedef struct alpi_vertex_detail {
    uint32_t point_count; // that light can reach
    double square;        // mean of (interpolant − accessibility)²; noise may put it below 0
    double edge;          // metres: longest edges of the triangles, where the error is
    double weight;        // Σ |square|
} alpi_vertex_detail;

/// Asks at points spread evenly over the scene's area, with about a tenth of the rays of a bake of
/// `options->samples` per vertex (at least 1,024 points, at most 65,536). Two independent estimates
/// at a point, their errors multiplied, give a mean square without the noise of the rays.
/// @param values [map->count]
/// @param details [surfaces] out
/// @param rays out: how many were traced
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_vertex_map_measure(const alpi_vertex_map *map, const alpi_tracer *tracer,
                                   const alp_occlusion_options *options, const float *values,
                                   alpi_vertex_detail *details, uint64_t *rays);

#endif
