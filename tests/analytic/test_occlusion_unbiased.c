// SPDX-License-Identifier: MIT
// No bias: over 64 seeds, few rays each, the mean of the error is zero within its own spread
// (Z-test). A bias of the estimator that many rays would hide in one run shows here.
#include "test_scenes.h"

#include <math.h>

enum { SEEDS = 64 };

/// Mean error over the seeds in units of its standard error. |Z| < 4 fails a sound estimator once
/// in 16,000 tests; the seeds are fixed, so this test passes or fails for good.
static double z_score(const alp_scene *scene, const double p[3], const double n[3],
                      alp_occlusion_options options, double exact)
{
    double sum = 0.0, squares = 0.0;
    for (int seed = 0; seed < SEEDS; seed++) {
        options.seed = (uint64_t)seed;
        double error = test_occlusion(scene, p, n, &options) - exact;
        sum += error;
        squares += error * error;
    }
    double mean = sum / SEEDS;
    double variance = (squares - SEEDS * mean * mean) / (SEEDS - 1);
    return mean / sqrt(variance / SEEDS + 1e-16);
}

TEST_WITH_CONTEXT(errors_average_out, 1)
{
    test_mesh *mesh = test_mesh_start(); // a 1 × 1 panel overhead and a wall aside
    test_mesh_quad(mesh, (double[]){0, 1, 0}, (double[]){1, 0, 0}, (double[]){0, 0, 1});
    test_mesh_quad(mesh, (double[]){-0.7, 0, 0}, (double[]){0, 3, 0}, (double[]){0, 0, 1.5});
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    double w = 1.5 / 0.7, h = 3 / 0.7, s = sqrt(1 + h * h);
    const double pi = 3.14159265358979323846;
    double exact = 1.0 - 0.138531606 - (atan(w) - atan(w / s) / s) / (2 * pi);
    const double p[3] = {0, 0, 0}, n[3] = {0, 1, 0};
    alp_occlusion_options options = alp_occlusion_options_default();
    options.distance = INFINITY;
    options.falloff = ALP_FALLOFF_NONE;
    const uint32_t samples[] = {1, 3, 16, 61, 64, 256, 1000};
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        options.samples = samples[i];
        double z = z_score(scene, p, n, options, exact);
        print_message("%u rays: Z = %+.2f\n", samples[i], z);
        assert_true(fabs(z) < 4.0);
    }
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(stratification_pays, 1)
{
    // The error of N stratified rays falls faster than N^-1/2: at 1,024 rays it must be well below
    // that of independent rays, √(A(1−A)/N) = .0153.
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){-0.5, 1, -0.5}, (double[]){1.7, 0, 0}, (double[]){0, 0, 1.3});
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    const double corners[4][3] = {{-0.5, 1, -0.5}, {1.2, 1, -0.5}, {1.2, 1, 0.8}, {-0.5, 1, 0.8}};
    const double p[3] = {0, 0, 0}, n[3] = {0, 1, 0};
    double exact = 1.0 - test_polygon_form_factor(p, n, corners, 4);
    alp_occlusion_options options = alp_occlusion_options_default();
    options.distance = INFINITY;
    options.falloff = ALP_FALLOFF_NONE;
    options.samples = 1024;
    double squares = 0.0;
    for (int seed = 0; seed < SEEDS; seed++) {
        options.seed = (uint64_t)seed;
        squares += pow(test_occlusion(scene, p, n, &options) - exact, 2);
    }
    double rmse = sqrt(squares / SEEDS), independent = sqrt(exact * (1 - exact) / 1024.0);
    print_message("rmse %.5f, independent rays %.5f\n", rmse, independent);
    assert_true(rmse < 0.35 * independent);
    alp_scene_destroy(scene);
}
