// SPDX-License-Identifier: MIT
// How samples are used: any number of them counts exactly, each receiver has its own, they continue
// one sequence, and each of a receiver's two normals does its own work.
#include "test_scenes.h"

#include "transport/occlusion/occlusion.h"

#include <math.h>

/// A lid of side 1 over a corner, at height 1 (oracle 6).
static alp_scene *lid_scene(alp_context *context)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 1, 0}, (double[]){1, 0, 0}, (double[]){0, 0, 1});
    return test_mesh_scene(context, mesh, 1);
}

static alp_occlusion_options open_options(uint32_t samples)
{
    alp_occlusion_options options = alp_occlusion_options_default();
    options.samples = samples;
    options.falloff = ALP_FALLOFF_NONE;
    options.distance = INFINITY;
    return options;
}

TEST_WITH_CONTEXT(any_number_of_samples_counts_exactly, 1)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0, 0, 0}, 1.0, 16, 8, 1.0, 0);
    alp_scene *closed = test_mesh_scene(context, mesh, 1);
    for (uint32_t samples = 1; samples <= 25; samples++) {
        for (int falloff = 0; falloff < 2; falloff++) {
            alp_occlusion_options options = open_options(samples);
            options.falloff = (alp_falloff)falloff;
            options.distance = falloff == 0 ? INFINITY : 1e30f; // w = 1 − t, t ≈ 0
            double point[3] = {0, 0, 0}, up[3] = {0, 1, 0};
            ASSERT_NEAR(test_occlusion(closed, point, up, &options), 0.0, 1e-6);
        }
    }
    alp_scene_destroy(closed);
}

TEST_WITH_CONTEXT(a_run_of_samples_continues_the_sequence, 1)
{
    alp_scene *scene = lid_scene(context);
    alpi_tracer *tracer = NULL;
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    alp_occlusion_options options = open_options(256);
    alpi_occlusion_setup setup;
    ASSERT_OK(context, alpi_occlusion_prepare(scene, tracer, &options, &setup));
    alpi_point_array points;
    ASSERT_OK(context, alpi_point_array_create(context, 11, &points)); // a packet and a part
    for (uint32_t i = 0; i < points.count; i++) {
        points.geometric_normals[i][1] = points.shading_normals[i][1] = 1.0f;
    }
    const alpi_receivers receivers = alpi_point_array_receivers(&points);
    const uint32_t runs[][2] = {{0, 256}, {0, 100}, {100, 156}};
    alpi_occlusion_sums sums[2];
    for (int i = 0; i < 2; i++) {
        ASSERT_OK(context, alpi_occlusion_sums_create(context, points.count, false, &sums[i]));
    }
    for (int i = 0; i < 3; i++) { // the first at once, the others one after the other
        ASSERT_OK(context, alpi_occlusion_add(&setup, &receivers, NULL, points.count, runs[i][0],
                                              runs[i][1], 256, NULL, &sums[i > 0]));
    }
    int different = 0;
    for (uint32_t i = 0; i < points.count; i++) {
        for (int q = 0; q < ALPI_QUARTERS; q++) {
            assert_int_equal(sums[0].open[i][q], sums[1].open[i][q]);
        }
        assert_int_equal(sums[1].done[i], 256);
        different += sums[0].open[i][0] != sums[0].open[i][1];
    }
    for (int i = 0; i < 2; i++) {
        alpi_occlusion_sums_destroy(context, &sums[i]);
    }
    alpi_point_array_destroy(context, &points);
    alpi_occlusion_release(&setup);
    assert_true(different > 0); // else a second run of samples would be the first one again
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(quarters_take_equal_shares_of_what_is_no_multiple, 1)
{
    alp_scene *scene = lid_scene(context);
    alpi_tracer *tracer = NULL;
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    alp_occlusion_options options = open_options(100);
    alpi_occlusion_setup setup;
    ASSERT_OK(context, alpi_occlusion_prepare(scene, tracer, &options, &setup));
    float point[3] = {0.0f, 2.0f, 0.0f}, up[3] = {0.0f, 1.0f, 0.0f}; // above all: every ray is free
    alpi_point_array points;
    ASSERT_OK(context, alpi_point_array_create(context, 1, &points));
    memcpy(points.positions[0], point, sizeof point);
    memcpy(points.geometric_normals[0], up, sizeof up);
    memcpy(points.shading_normals[0], up, sizeof up);
    const alpi_receivers receivers = alpi_point_array_receivers(&points);
    // 64, then 36 more, and all 100 at once: 16 + 9 in each quarter.
    const uint32_t runs[][2] = {{0, 64}, {64, 36}, {0, 100}};
    alpi_occlusion_sums sums;
    for (int i = 0; i < 3; i++) {
        if (i != 1) {
            ASSERT_OK(context, alpi_occlusion_sums_create(context, 1, false, &sums));
        }
        sums.parted = i == 0 ? 0 : 64;
        ASSERT_OK(context, alpi_occlusion_add(&setup, &receivers, NULL, 1, runs[i][0], runs[i][1],
                                              i == 0 ? 64 : 100, NULL, &sums));
        for (int q = 0; q < ALPI_QUARTERS; q++) {
            assert_int_equal(sums.open[0][q], i == 0 ? 16 : 25);
        }
        if (i != 0) {
            alpi_occlusion_sums_destroy(context, &sums);
        }
    }
    alpi_point_array_destroy(context, &points);
    alpi_occlusion_release(&setup);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(every_receiver_has_its_own_samples, 1)
{
    enum { COUNT = 1024 };
    alp_scene *scene = lid_scene(context);
    static float positions[COUNT][3], normals[COUNT][3], values[COUNT];
    for (int i = 0; i < COUNT; i++) {
        normals[i][1] = 1.0f;
    }
    alp_occlusion_options options = open_options(64);
    ASSERT_OK(context, alp_occlusion_at_points(scene, COUNT, positions[0], NULL, normals[0],
                                               &options, values));
    double mean = 0.0;
    int different = 0;
    for (int i = 0; i < COUNT; i++) {
        mean += (double)values[i] / COUNT;
        different += values[i] != values[0];
    }
    assert_true(different > COUNT / 4); // of few values near the true one
    // And errors that differ cancel: 1,024 × 64 samples meet the closed form (by .0005 in the
    // mean).
    ASSERT_NEAR(mean, 1.0 - 0.138531606, 2e-3);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(the_shading_normal_is_the_axis, 1)
{
    alp_scene *scene = lid_scene(context);
    const double corners[4][3] = {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}};
    const double point[3] = {0, 0, 0}, shading[3] = {0.8, 0.6, 0.0};
    float position[3] = {0, 0, 0}, up[3] = {0, 1, 0}, axis[3] = {0.8f, 0.6f, 0.0f}, value = 0.0f;
    alp_occlusion_options options = open_options(1u << 16);
    ASSERT_OK(context, alp_occlusion_at_points(scene, 1, position, up, axis, &options, &value));
    ASSERT_NEAR(value, 1.0 - test_polygon_form_factor(point, shading, corners, 4), 1e-3);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(rays_start_on_the_geometric_side, 1)
{
    // A floor seen from above with an axis that points into it: every ray hits the floor. Had the
    // start been moved along the axis, it would be below the floor and every ray free.
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){-9, 1, 9}, (double[]){18, 0, 0}, (double[]){0, 0, -18});
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    float position[3] = {0.5f, 1.0f, 0.25f}, up[3] = {0, 1, 0}, down[3] = {0, -1, 0}, value = 1.0f;
    alp_occlusion_options options = open_options(256);
    options.cone = 1.0f;
    ASSERT_OK(context, alp_occlusion_at_points(scene, 1, position, up, down, &options, &value));
    ASSERT_NEAR(value, 0.0, 0.0);
    ASSERT_OK(context, alp_occlusion_at_points(scene, 1, position, down, down, &options, &value));
    ASSERT_NEAR(value, 1.0, 0.0);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(the_automatic_distance_is_a_fifth_of_the_diagonal, 1)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){5, 0, 0}, (double[]){2, 0, 0}, (double[]){0, 3, 6});
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    alp_occlusion_options options = alp_occlusion_options_default();
    ASSERT_NEAR(alp_occlusion_distance(scene, &options), 0.2 * 7.0, 1e-6);
    options.distance = 0.75f;
    ASSERT_NEAR(alp_occlusion_distance(scene, &options), 0.75, 0.0);
    alp_scene_destroy(scene);
}
