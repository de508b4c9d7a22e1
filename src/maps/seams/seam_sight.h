// SPDX-License-Identifier: MIT
// Whether the two sides of a seam see each other. Rays cross the seam just above the surface, from
// a texel on one side of the edge to a texel on the other. A wall that stands there stops them.
//
//           from o-----------------------------------o to       high: ½ texel above the edge
//           from o-----------------------------------o to       low: .1 texel above the edge
//      ==========+=================|=================+==========
//                    one texel    edge    one texel
//
// Each end lies at most half the scale of its triangle inward, and is lifted along the mean of the
// two normals. Over a convex edge they are lifted by as much as the edge lies above the ends.
#ifndef ALPI_MAPS_SEAM_SIGHT_H
#define ALPI_MAPS_SEAM_SIGHT_H

#include "maps/seams/seam_edges.h"
#include "trace/trace.h"

enum { ALPI_SIGHT_RAYS = 2 }; // of a sample: low and high

/// The rays of a sample.
typedef struct alpi_sight {
    vec3 from[ALPI_SIGHT_RAYS], to[ALPI_SIGHT_RAYS]; // metres
    bool aimed; // false: the triangles are too thin or too sharply folded; no ray is traced
    bool blocked;
} alpi_sight;

/// @param half_edges of the two sides   @param shares the place on each, of its length
/// @param texels     metres, of a texel along each
alpi_sight alpi_sight_aim(const alp_scene *scene, const uint32_t half_edges[2],
                          const double shares[2], const float texels[2]);

/// Traces the rays of some samples. Panes stop no ray.
/// @return ALP_OK; CANCELLED by who watches the context
alp_result alpi_sight_trace(const alpi_tracer *tracer, alp_context *context, alpi_sight *sights,
                            uint32_t count);

#endif
