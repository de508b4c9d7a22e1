// SPDX-License-Identifier: MIT
// Which points lie inside solids, by rings: four rays around a point.
#ifndef ALPI_MAPS_INSIDE_H
#define ALPI_MAPS_INSIDE_H

#include "scene/receivers.h"
#include "trace/trace.h"

/// Directions of a ring: the axes of a tangent frame, those between them, or these raised to 55°
/// from the surface.
typedef enum alpi_ring_kind {
    ALPI_RING_AXES,
    ALPI_RING_DIAGONALS,
    ALPI_RING_RAISED
} alpi_ring_kind;

/// Origin of the rays of a ring. It is higher than that of other rays, since a tangent ray must not
/// hit its own, slightly bent surface. @param side of the texel, metres
vec3 alpi_ring_origin(const alpi_receiver_point *point, float side);

/// Sets the four rays of a ring. @param length metres   @param lane of the first
void alpi_ring_aim(const alpi_receiver_point *point, float side, alpi_ring_kind kind, float length,
                   int lane, alpi_rays *rays);

/// Finds the points that lie inside other geometry. One of these must hold:
/// - A tangent ray of a texel's length hits a back face first.
/// - Three of four raised rays hit a back face first.
/// - All four raised rays hit something near, and along three of their lines more backs than fronts
///   lie on the way out.
/// Back faces of double-sided materials and of panes do not count: light gets in there.
/// @param points [32 at most]   @param sides [points] of their texels, metres
/// @param tested bit i: test point i
/// @return bit i: point i was tested, and is inside
uint32_t alpi_are_inside(const alpi_tracer *tracer, const alp_scene *scene,
                         const alpi_receiver_point *points, const float *sides, uint32_t tested);

#endif
