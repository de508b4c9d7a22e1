// SPDX-License-Identifier: MIT
// Small scenes that several tests build: quads, boxes, spheres; and closed forms to hold them to.
#ifndef TEST_SCENES_H
#define TEST_SCENES_H

#include "test_support.h"

enum { TEST_VERTEX_LIMIT = 200000, TEST_TRIANGLE_LIMIT = 400000 };

/// A growing triangle mesh in static storage; one at a time.
typedef struct test_mesh {
    uint32_t vertex_count, triangle_count;
    float (*positions)[3];
    uint32_t (*triangles)[3];
} test_mesh;

/// Empties and returns the static mesh.
test_mesh *test_mesh_start(void);
uint32_t test_mesh_vertex(test_mesh *mesh, double x, double y, double z);
void test_mesh_triangle(test_mesh *mesh, uint32_t a, uint32_t b, uint32_t c);
/// Counter-clockwise corners seen from outside: p, p+u, p+u+v, p+v (normal u × v).
void test_mesh_quad(test_mesh *mesh, const double p[3], const double u[3], const double v[3]);
/// UV sphere: `outside` winds it to be seen from outside, else from inside. Latitudes from the −y
/// pole to the height y_cut (in units of the radius; 1 = closed).
void test_mesh_sphere(test_mesh *mesh, const double center[3], double radius, int slices,
                      int stacks, double y_cut, int outside);
/// Makes the scene (flat normals).
alp_scene *test_mesh_scene(alp_context *context, const test_mesh *mesh, int double_sided);

/// Openness of the half space at a point with normal n, seen through a polygon: oracle 11,
/// F = |Σ γ_i (n·Γ_i)| / 2π after clipping to the horizon.
double test_polygon_form_factor(const double point[3], const double normal[3],
                                const double (*corners)[3], int count);

/// Accessibility of one point with these options.
double test_occlusion(const alp_scene *scene, const double position[3], const double normal[3],
                      const alp_occlusion_options *options);

#endif
