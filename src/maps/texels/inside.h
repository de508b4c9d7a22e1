// SPDX-License-Identifier: MIT
// Which points lie inside solids: looks around them, by a few rays.
#ifndef ALPI_MAPS_INSIDE_H
#define ALPI_MAPS_INSIDE_H

#include "scene/receivers.h"
#include "trace/trace.h"

/// Directions of the four rays of a look: tangent ones, of a frame or between those, or at 55° to
/// the surface.
typedef enum alpi_look_kind { ALPI_LOOK_ALONG, ALPI_LOOK_BETWEEN, ALPI_LOOK_UP } alpi_look_kind;

/// Where rays that look around start: higher than rays usually do, as a tangent one must not graze
/// its own, slightly bent surface. @param side of the texel, metres
vec3 alpi_look_start(const alpi_receiver_point *point, float side);

/// Sets the four rays of a look. @param length metres   @param lane of the first
void alpi_look_aim(const alpi_receiver_point *point, float side, alpi_look_kind kind, float length,
                   int lane, alpi_rays *rays);

/// Which of some points lie inside other geometry: a back face is the first thing beside one within
/// a texel, or above it in three of four directions; or, where something is near in all four, more
/// backs than fronts lie on the ways out. Back faces of double-sided materials and of panes are no
/// sign of an inside.
/// @param points [32 at most]   @param sides [points] of their texels, metres
/// @param asked bit i: whether point i is
/// @return bit i: point i was asked, and is inside
uint32_t alpi_are_inside(const alpi_tracer *tracer, const alp_scene *scene,
                         const alpi_receiver_point *points, const float *sides, uint32_t asked);

#endif
