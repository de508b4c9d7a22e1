// SPDX-License-Identifier: MIT
// Vertices as receivers: which are one, what part of the surface each stands for, and what the fit
// makes of means.
#include "test_scenes.h"

#include "base/random.h"
#include "maps/vertex/vertex_map.h"
#include "transport/occlusion/occlusion.h"

#include <math.h>
#include <stdlib.h>

enum { POINTS = 4096 };

static alpi_vertex_map make_map(const alp_scene *scene)
{
    alpi_vertex_map map;
    ASSERT_OK(scene->context, alpi_vertex_map_create(scene, &map));
    return map;
}

/// A scene of one mesh with normals.
static alp_scene *make_scene(alp_context *context, uint32_t vertices, const float *positions,
                             const float *normals, uint32_t triangles, const uint32_t *indices)
{
    alp_mesh mesh = {.vertex_count = vertices,
                     .positions = positions,
                     .normals = normals,
                     .triangle_count = triangles,
                     .indices = indices};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    return scene;
}

/// `count` points of a receiver.
static void place(const alpi_vertex_map *map, uint32_t receiver, uint32_t count,
                  alpi_receiver_point *points)
{
    static float square[POINTS][2];
    for (uint32_t i = 0; i < count; i++) {
        vec2 u = alpi_sample_2d(alpi_random_key(5, receiver, 0), i);
        square[i][0] = u.x;
        square[i][1] = u.y;
    }
    alpi_receivers receivers = alpi_vertex_map_receivers(map);
    receivers.place(receivers.user, receiver, count, (const float(*)[2])square, points);
}

// --- which are one -------------------------------------------------------------------------------

TEST_WITH_CONTEXT(equal_position_and_normal_are_one, 1)
{
    // Two triangles at an edge whose vertices the file splits: 0 = 3 in all; 2 and 4 differ by
    // their normals; 6 belongs to no triangle.
    const float positions[7][3] = {{0, 0, 0}, {1, 0, 0},  {0, 1, 0}, {-0.0f, 0, 0},
                                   {0, 1, 0}, {-1, 0, 0}, {5, 5, 5}};
    const float normals[7][3] = {{0, 0, 1},       {0, 0, 1}, {0, 0, 1}, {0, 0, 1},
                                 {0, 0.6f, 0.8f}, {0, 0, 1}, {0, 0, 1}};
    const uint32_t indices[2][3] = {{0, 1, 2}, {3, 4, 5}};
    alp_scene *scene = make_scene(context, 7, positions[0], normals[0], 2, indices[0]);
    alpi_vertex_map map = make_map(scene);
    assert_int_equal(map.count, 5);
    assert_int_equal(map.vertex_receivers[0], map.vertex_receivers[3]);
    assert_int_not_equal(map.vertex_receivers[2], map.vertex_receivers[4]);
    assert_int_equal(map.vertex_receivers[6], ALPI_NONE);
    ASSERT_NEAR(map.areas[map.vertex_receivers[0]], 1.0 / 3.0, 1e-9); // of both triangles
    ASSERT_NEAR(map.areas[map.vertex_receivers[1]], 1.0 / 6.0, 1e-9);
    alpi_vertex_map_destroy(&map);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(shares_make_up_the_surface, 1)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){1, 2, 3}, 2.0, 12, 7, 1.0, 1);
    alp_scene *scene = test_mesh_scene(context, mesh, 0); // flat: each facet is apart
    alpi_vertex_map map = make_map(scene);
    double sum = 0.0;
    for (uint32_t i = 0; i < map.count; i++) {
        assert_true(map.first_share[i] < map.first_share[i + 1]);
        ASSERT_NEAR(map.ends[map.first_share[i + 1] - 1], 1.0, 1e-6);
        sum += map.areas[i];
    }
    ASSERT_NEAR(sum, scene->area, 1e-9 * scene->area);
    assert_int_equal(map.first_share[map.count], 3 * scene->usable_count);
    alpi_vertex_map_destroy(&map);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(many_normals_at_one_place_take_no_ages, 1)
{
    enum { FANS = 20000 };
    float(*positions)[3] = calloc(3 * FANS, sizeof *positions);
    float(*normals)[3] = calloc(3 * FANS, sizeof *normals);
    uint32_t(*indices)[3] = calloc(FANS, sizeof *indices);
    assert_true(positions != NULL && normals != NULL && indices != NULL);
    for (uint32_t i = 0; i < FANS; i++) { // first corners all at the origin
        double angle = 2.0 * ALPI_PI * i / FANS;
        for (uint32_t k = 0; k < 3; k++) {
            indices[i][k] = 3 * i + k;
            positions[3 * i + k][0] = k == 0 ? 0.0f : (float)k;
            positions[3 * i + k][1] = k == 2 ? 1.0f + (float)i : 0.0f;
            normals[3 * i + k][0] = (float)cos(angle);
            normals[3 * i + k][2] = (float)sin(angle);
        }
    }
    alp_scene *scene = make_scene(context, 3 * FANS, positions[0], normals[0], FANS, indices[0]);
    alpi_vertex_map map = make_map(scene);
    assert_true(map.count > FANS);
    alpi_vertex_map_destroy(&map);
    alp_scene_destroy(scene);
    free(positions);
    free(normals);
    free(indices);
}

// --- points --------------------------------------------------------------------------------------

TEST_WITH_CONTEXT(points_are_uniform_over_the_share, 1)
{
    // Vertex 0 has two triangles in the plane z = 0: on the left (area 1.5) and the right (area 1).
    const float positions[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {-3, 0, 0}};
    const float normals[4][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    const uint32_t indices[2][3] = {{0, 1, 2}, {2, 3, 0}};
    alp_scene *scene = make_scene(context, 4, positions[0], normals[0], 2, indices[0]);
    alpi_vertex_map map = make_map(scene);
    static alpi_receiver_point points[POINTS];
    place(&map, map.vertex_receivers[0], POINTS, points);
    double right = 0.0, own = 0.0, along = 0.0;
    for (int i = 0; i < POINTS; i++) {
        double x = (double)points[i].position.x, y = (double)points[i].position.y;
        double side = x > 0.0 ? x / 2.0 : x / -3.0; // weight of the outer corner
        double rest = 1.0 - side - y;
        assert_true(rest >= side - 1e-6 && rest >= y - 1e-6);
        ASSERT_NEAR(points[i].position.z, 0.0, 0.0);
        ASSERT_NEAR(points[i].geometric_normal.z, 1.0, 1e-6);
        ASSERT_NEAR(points[i].shading_normal.z, 1.0, 1e-6);
        assert_true(points[i].offset > 0.0f);
        right += x > 0.0;
        own += rest;
        along += side;
    }
    // Stratified points: errors far below 1/√N; 1e-2 leaves a factor of ten.
    ASSERT_NEAR(right / POINTS, 1.0 / 2.5, 1e-2);
    ASSERT_NEAR(own / POINTS, 11.0 / 18.0, 1e-2);
    ASSERT_NEAR(along / POINTS, 7.0 / 36.0, 1e-2);
    alpi_vertex_map_destroy(&map);
    alp_scene_destroy(scene);
}

// --- the fit -------------------------------------------------------------------------------------

TEST_WITH_CONTEXT(one_triangle_has_a_closed_form, 1)
{
    // Deviations from the mean of the three: (11/18 − 7/36 + 1/2) out = (1 + 1/2) in, out = 18/11
    // in.
    const float positions[3][3] = {{0, 0, 0}, {4, 0, 0}, {1, 3, 0}};
    const float normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    const uint32_t indices[3] = {0, 1, 2};
    alp_scene *scene = make_scene(context, 3, positions[0], normals[0], 1, indices);
    alpi_vertex_map map = make_map(scene);
    float values[3] = {0.5f, 0.6f, 0.4f};
    ASSERT_OK(context, alpi_vertex_map_fit(&map, values));
    const double shift = 0.1 * 18.0 / 11.0;
    ASSERT_NEAR(values[0], 0.5, 1e-6);
    ASSERT_NEAR(values[1], 0.5 + shift, 1e-6);
    ASSERT_NEAR(values[2], 0.5 - shift, 1e-6);
    float steep[3] = {1.0f, 0.9f, 0.1f}; // overshoots are held
    ASSERT_OK(context, alpi_vertex_map_fit(&map, steep));
    ASSERT_NEAR(steep[0], 1.0, 0.0);
    ASSERT_NEAR(steep[2], 0.0, 0.0);
    alpi_vertex_map_destroy(&map);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(constants_and_the_mean_are_kept, 1)
{
    test_mesh *mesh = test_mesh_start();
    for (int i = 0; i <= 9; i++) { // an uneven strip
        test_mesh_vertex(mesh, i * i, 0, 0);
        test_mesh_vertex(mesh, i * i - 0.5, 0, -1 - i);
    }
    for (uint32_t i = 0; i < 18; i += 2) {
        test_mesh_triangle(mesh, i, i + 2, i + 1);
        test_mesh_triangle(mesh, i + 1, i + 2, i + 3);
    }
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alpi_vertex_map map = make_map(scene);
    assert_int_equal(map.count, 20); // flat, and in one plane
    float values[20];
    float means[20];
    double before = 0.0, after = 0.0, moved = 0.0;
    for (uint32_t i = 0; i < 20; i++) {
        values[i] = 0.3f;
    }
    ASSERT_OK(context, alpi_vertex_map_fit(&map, values));
    for (uint32_t i = 0; i < 20; i++) {
        ASSERT_NEAR(values[i], 0.3, 1e-6);
        values[i] = 0.4f + 0.02f * (float)(i * 7 % 10);
        before += map.areas[i] * (double)values[i];
        means[i] = values[i];
    }
    ASSERT_OK(context, alpi_vertex_map_fit(&map, values));
    for (uint32_t i = 0; i < 20; i++) {
        after += map.areas[i] * (double)values[i];
        moved = fmax(moved, fabs((double)(values[i] - means[i])));
    }
    ASSERT_NEAR(after / scene->area, before / scene->area, 1e-6);
    assert_true(moved > 0.01); // it did something
    alpi_vertex_map_destroy(&map);
    alp_scene_destroy(scene);
}

// --- occlusion -----------------------------------------------------------------------------------

TEST_WITH_CONTEXT(vertices_before_a_long_wall, 2)
{
    // A floor point at distance d from a wall of height 1 and no end sees (1 + d / √(d² + 1)) / 2.
    // The wall ends 500 m away: 1e-6 of the hemisphere. Expected at a vertex: the mean of that over
    // its share.
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 500}, (double[]){0, 0, -1000}, (double[]){0, 1, 0});
    for (int i = 0; i < 8; i++) {
        test_mesh_quad(mesh, (double[]){0.25 * i, 0, 0.25}, (double[]){0.25, 0, 0},
                       (double[]){0, 0, -0.25});
    }
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    alpi_vertex_map map = make_map(scene);
    assert_int_equal(map.count, 4 + 18);
    alpi_tracer *tracer = NULL;
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    alp_occlusion_options options = alp_occlusion_options_default();
    options.samples = 16384;
    options.distance = INFINITY;
    options.falloff = ALP_FALLOFF_NONE;
    alpi_occlusion_setup setup;
    ASSERT_OK(context, alpi_occlusion_prepare(scene, tracer, &options, &setup));
    float values[22];
    const alpi_receivers receivers = alpi_vertex_map_receivers(&map);
    ASSERT_OK(context, alpi_occlusion_gather(&setup, &receivers, NULL, map.count, values));
    static alpi_receiver_point points[POINTS];
    for (uint32_t i = 4; i < map.count; i++) {
        double expected = 0.0;
        place(&map, i, POINTS, points);
        for (int k = 0; k < POINTS; k++) {
            double d = (double)points[k].position.x;
            expected += (1.0 + d / sqrt(d * d + 1.0)) / 2.0 / POINTS;
        }
        ASSERT_NEAR(values[i], expected, 4.0 * 0.5 / sqrt(16384.0));
    }
    alpi_occlusion_release(&setup);
    alpi_vertex_map_destroy(&map);
    alp_scene_destroy(scene);
}
