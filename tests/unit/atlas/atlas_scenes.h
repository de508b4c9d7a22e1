// SPDX-License-Identifier: MIT
// Scenes that the tests of this room share, and what they ask of an atlas.
#ifndef ATLAS_SCENES_H
#define ATLAS_SCENES_H

#include "test_support.h"

#include "atlas/stages.h"

/// A scene of one mesh; uvs may be NULL.
alp_scene *scene_of(alp_context *context, const float (*positions)[3], const float (*uvs)[2],
                    uint32_t vertex_count, const uint32_t (*indices)[3], uint32_t triangle_count);
/// A cube of side 2 with 12 triangles that share 8 vertices.
alp_scene *scene_cube(alp_context *context);
/// A sphere of radius 1 in rings × segments, poles as triangles.
alp_scene *scene_sphere(alp_context *context, uint32_t rings, uint32_t segments);
/// A flat square of side 2 in the plane y = 0 of n × n squares, its normal up.
alp_scene *scene_plane(alp_context *context, uint32_t n);
/// A spiral ramp of `turns` turns, 16 steps each, that lies over itself seen from above.
alp_scene *scene_spiral(alp_context *context, uint32_t turns);
/// `count` loose triangles of keyed random shape, place and size (10^-4 … 1 m).
alp_scene *scene_confetti(alp_context *context, uint32_t count);

/// New charts on pages of this size, as dense as one page allows.
alp_atlas *charts_of_size(alp_context *context, const alp_scene *scene, uint32_t size);
enum { POINT_GRID = 32, GRID_POINTS = POINT_GRID * POINT_GRID };
/// The middles of POINT_GRID × POINT_GRID cells of the unit square, [GRID_POINTS][2].
void fill_point_grid(float (*square)[2]);

/// Signed area of a triangle of an atlas in its page, in texels.
double texel_area(const alp_atlas *atlas, uint32_t triangle);
/// How many texels hold more than one triangle at one place.
uint32_t overlapping_texels(const alp_atlas *atlas);
/// Random number in [0, 1) keyed by two integers.
double keyed(uint32_t a, uint32_t b);

#endif
