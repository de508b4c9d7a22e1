// SPDX-License-Identifier: MIT
// Builds a scene piece by piece. The first failure is kept and makes every later call do nothing,
// so that a scene reads as a list of its parts; alpi_builder_finish says how it went.
#ifndef ALPI_SCENE_MESH_BUILDER_H
#define ALPI_SCENE_MESH_BUILDER_H

#include "scene/scene.h"

typedef struct alpi_builder {
    alp_context *context;
    alp_scene *scene;
    alp_result result;
    size_t position_capacity, normal_capacity, source_capacity;
    size_t triangle_capacity, owner_capacity;
    size_t surface_capacity, material_capacity, camera_capacity;
} alpi_builder;

void alpi_builder_start(alpi_builder *builder, alp_context *context, const char *name);

/// @param color diffuse albedo @param emission radiance, W·sr⁻¹·m⁻²
/// @return index for alpi_builder_surface
uint32_t alpi_builder_material(alpi_builder *builder, const char *name, vec3 color, vec3 emission);

/// Begins a surface: what follows belongs to it.
void alpi_builder_surface(alpi_builder *builder, const char *name, uint32_t material);

/// @return index for alpi_builder_triangle, within the whole scene
uint32_t alpi_builder_vertex(alpi_builder *builder, vec3 position, vec3 normal);
/// Corners counter-clockwise, seen from outside.
void alpi_builder_triangle(alpi_builder *builder, uint32_t a, uint32_t b, uint32_t c);

/// A flat (or nearly flat) quad with four vertices of its own, counter-clockwise.
void alpi_builder_quad(alpi_builder *builder, const vec3 corners[4]);

/// Faces of a box: the one towards −x, +x, …
enum {
    ALPI_FACE_LEFT = 1,   // −x
    ALPI_FACE_RIGHT = 2,  // +x
    ALPI_FACE_BOTTOM = 4, // −y
    ALPI_FACE_TOP = 8,    // +y
    ALPI_FACE_BACK = 16,  // −z
    ALPI_FACE_FRONT = 32, // +z
    ALPI_FACE_ALL = 63
};
/// Those faces of an axis-aligned box, seen from outside; from inside where low > high.
void alpi_builder_box(alpi_builder *builder, vec3 low, vec3 high, unsigned faces);

/// A flat rectangle cut into cells at the same lines as its neighbours, so that no vertex of one
/// lies on an edge of the other; one cell may be left out (a doorway).
typedef struct alpi_panel {
    vec3 origin, u, v; // unit axes; the normal is u × v
    const float *u_cuts, *v_cuts;
    uint32_t u_count, v_count; // of cuts, both ends included
    uint32_t hole_u, hole_v;   // cell that is left out, ALPI_NONE = none
} alpi_panel;
void alpi_builder_panel(alpi_builder *builder, const alpi_panel *panel);

/// A sphere of quads, triangles at the poles, between the −y pole and the height center.y + top
/// (top = radius: closed). Vertices lie on the sphere.
typedef struct alpi_ball {
    vec3 center;
    float radius, top;
    uint32_t slices, stacks; // around, and from bottom to top; at least 3 and 2
    bool inside;             // seen from inside, normals too
} alpi_ball;
void alpi_builder_ball(alpi_builder *builder, const alpi_ball *ball);

/// A torus about the y axis through its centre; vertices lie on it.
typedef struct alpi_ring {
    vec3 center;
    float major_radius, minor_radius;
    uint32_t slices, sides; // around the axis, around the tube; at least 3
} alpi_ring;
void alpi_builder_ring(alpi_builder *builder, const alpi_ring *ring);

/// A profile turned about the y axis through `foot`: points (radius, height), from the bottom up
/// the outside, over the rim and down the inside. Each piece between two points is smooth around
/// and has its own edge to the next.
typedef struct alpi_lathe {
    vec3 foot;
    const float (*profile)[2];
    uint32_t point_count, slices;
} alpi_lathe;
void alpi_builder_lathe(alpi_builder *builder, const alpi_lathe *lathe);

/// (cos, sin) of 2π i/n, exact at the quarters, so that symmetric shapes are symmetric.
void alpi_builder_turn(uint32_t i, uint32_t n, double *cosine, double *sine);

/// @param vertical_fov radians; up is +y
void alpi_builder_camera(alpi_builder *builder, vec3 position, vec3 target, float vertical_fov);

/// Completes the scene, or destroys it and returns the first failure.
alp_result alpi_builder_finish(alpi_builder *builder, alp_scene **scene);

#endif
