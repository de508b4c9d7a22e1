// SPDX-License-Identifier: MIT
// Directions from a point to a triangle, uniform in its solid angle, or in its area where it is
// small.
#ifndef ALPI_SCENE_TRIANGLE_LIGHT_H
#define ALPI_SCENE_TRIANGLE_LIGHT_H

#include "scene/double3.h"

/// A triangle as a point sees it.
typedef struct alpi_triangle_view {
    double3 corner[3];  // from the point
    double3 cross;      // (corner 1 − corner 0) × (corner 2 − corner 0): twice the area
    double determinant; // of the corners: six times the volume; 0 where the point is in the plane
    double solid_angle; // steradians; of a small triangle to a few thousandths
    bool by_area;       // small beside its distance, or too close to half the sphere for the solid
                        // angle's formula
} alpi_triangle_view;

alpi_triangle_view alpi_triangle_view_from(vec3 point, const vec3 corner[3]);

/// Where a direction from the point meets the triangle's plane, the nearest place inside.
typedef struct alpi_triangle_hit {
    float b1, b2;
    double distance; // metres; INFINITY along the plane
} alpi_triangle_hit;
alpi_triangle_hit alpi_triangle_hit_at(const alpi_triangle_view *view, double3 direction);

/// Draws a unit direction to the triangle, uniform in solid angle; uniform in area where
/// `by_area`. @param u [0,1)²
/// Based on: James Arvo. Stratified Sampling of Spherical Triangles. SIGGRAPH 1995.
double3 alpi_triangle_sample(const alpi_triangle_view *view, vec2 u);

/// Density, per steradian, of drawing a direction that meets the triangle; 0 where there is none
/// that a number can hold (the point in the triangle's plane).
double alpi_triangle_density(const alpi_triangle_view *view, double3 direction);

#endif
