// SPDX-License-Identifier: MIT
// Points of a triangle as receivers: position, normals, and the lift to the smooth surface that
// the triangle stands for.
#ifndef ALPI_ATLAS_FACET_H
#define ALPI_ATLAS_FACET_H

#include "scene/receivers.h"
#include "scene/scene.h"

/// What all points of a triangle share.
typedef struct alpi_facet {
    double corner[3], edges[2][3]; // metres: corner 0, and from it to corners 1 and 2
    vec3 geometric;                // of the side that maps hold (scene/sides.h)
    float offset;                  // metres, enough for any of its points
    bool smooth;                   // the shading normal is not the geometric one everywhere
    bool lifted;                   // some of its points are below the tangent plane of a corner
    float normals[3][3];           // unit, of the corners; set if smooth
    float heights[3][3]; // metres: of corner j above the tangent plane of corner i; set if lifted
    float lift_limit;    // metres
    float lift_share;    // of the way to the tangent planes; 0 where normals describe creases
} alpi_facet;

/// @param lift whether points may leave the triangle for the smooth surface
void alpi_facet_load(const alp_scene *scene, uint32_t triangle, bool lift, alpi_facet *facet);

/// The point at barycentrics b (weights of corners 1 and 2).
/// @param low NULL, or out: its position before any lift
void alpi_facet_point(const alpi_facet *facet, const double b[2], alpi_receiver_point *point,
                      vec3 *low);

/// Points of a parallelogram of the triangle: that of (x, y) of the unit square lies at
/// barycentrics at + x · by_x + y · by_y.
typedef struct alpi_facet_patch {
    double at[2], by_x[2], by_y[2];
} alpi_facet_patch;
void alpi_facet_points(const alpi_facet *facet, const alpi_facet_patch *patch, uint32_t count,
                       const float (*square)[2], alpi_receiver_point *points, vec3 *lows);

/// The shading normal there: the corners' interpolated, or the geometric one where that would point
/// below the triangle, since a hemisphere inside the surface sees nothing.
vec3 alpi_facet_normal(const alpi_facet *facet, const float weights[3]);

#endif
