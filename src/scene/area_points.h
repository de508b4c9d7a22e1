// SPDX-License-Identifier: MIT
// Points spread evenly over the surface of a scene.
#ifndef ALPI_SCENE_AREA_POINTS_H
#define ALPI_SCENE_AREA_POINTS_H

#include "scene/scene.h"

typedef alpi_surface_place alpi_area_point;

/// `count` points on usable triangles, of which each stands for the same area: the area is cut into
/// as many parts in the order of the triangles, with a point in the middle of each; where it lies
/// in its triangle is a fixed function of its number.
/// @param points [count] out
/// @return false: there is no area, and no point
/// Cost: a look at each triangle.
bool alpi_area_points(const alp_scene *scene, uint32_t count, alpi_area_point *points);

#endif
