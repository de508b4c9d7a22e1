// SPDX-License-Identifier: MIT
// Coloured obscurance against exact answers, and against occlusion where nothing reflects.
#include "test_scenes.h"

#include <math.h>

static const double TOLERANCE = 1e-3;
static const double FAR = 1e5; // stands for infinite

TEST_CONTEXT(2);

static alp_occlusion_options open_options(void)
{
    alp_occlusion_options o = alp_occlusion_options_default();
    o.samples = 1u << 14;
    o.distance = INFINITY;
    o.falloff = ALP_FALLOFF_NONE;
    return o;
}

static alp_scene *colored_scene(const test_mesh *mesh, const float color[3], bool double_sided)
{
    const alp_mesh m = {.name = "test",
                        .vertex_count = mesh->vertex_count,
                        .positions = mesh->positions[0],
                        .triangle_count = mesh->triangle_count,
                        .indices = mesh->triangles[0],
                        .base_color = {color[0], color[1], color[2]},
                        .double_sided = double_sided};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &m, 1, &scene));
    return scene;
}

static void obscurance(const alp_scene *scene, const double position[3],
                       const alp_occlusion_options *options, double rgb[3])
{
    const float n[3] = {0, 1, 0};
    float p[3], out[3];
    for (int k = 0; k < 3; k++) {
        p[k] = (float)position[k];
    }
    ASSERT_OK(context, alp_obscurance_at_points(scene, 1, p, NULL, n, options, out));
    for (int k = 0; k < 3; k++) {
        rgb[k] = (double)out[k];
    }
}

static const float COLOR[3] = {0.8f, 0.3f, 0.1f}, BLACK[3] = {0, 0, 0};
static const double ORIGIN[3] = {0, 0, 0}, UP[3] = {0, 1, 0};

TEST(closed_room_shows_its_albedo)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, ORIGIN, 1.0, 32, 16, 1.0, 0);
    alp_scene *scene = colored_scene(mesh, COLOR, false);
    alp_occlusion_options options = open_options();
    for (int k = 0; k < 20; k++) {
        double rgb[3];
        obscurance(scene, (double[]){0.04 * k - 0.4, 0.3, 0.02 * k}, &options, rgb);
        for (int c = 0; c < 3; c++) {
            ASSERT_NEAR(rgb[c], COLOR[c], 1e-6);
        }
    }
    alp_scene_destroy(scene);
}

TEST(plate_overhead_reflects)
{
    // Oracle 11: W = 1 − F + F ρ, from both sides of a double-sided plate.
    const double corners[4][3] = {
        {-0.4, 0.7, 1}, {0.9, 0.7, 1}, {0.9, 0.7, -0.5}, {-0.4, 0.7, -0.5}};
    const double f = test_polygon_form_factor(ORIGIN, UP, corners, 4);
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, corners[0], (double[]){1.3, 0, 0}, (double[]){0, 0, -1.5}); // faces up
    alp_occlusion_options options = open_options();
    double rgb[3];
    alp_scene *scene = colored_scene(mesh, COLOR, true);
    obscurance(scene, ORIGIN, &options, rgb);
    for (int c = 0; c < 3; c++) {
        ASSERT_NEAR(rgb[c], 1.0 - f + f * (double)COLOR[c], TOLERANCE);
    }
    alp_scene_destroy(scene);

    scene = colored_scene(mesh, COLOR, false); // black from behind, or open
    obscurance(scene, ORIGIN, &options, rgb);
    ASSERT_NEAR(rgb[0], 1.0 - f, TOLERANCE);
    options.one_sided = true;
    obscurance(scene, ORIGIN, &options, rgb);
    ASSERT_NEAR(rgb[0], 1.0, 0.0);
    alp_scene_destroy(scene);

    mesh = test_mesh_start(); // faces down: single-sided is enough
    test_mesh_quad(mesh, corners[3], (double[]){1.3, 0, 0}, (double[]){0, 0, 1.5});
    scene = colored_scene(mesh, COLOR, false);
    obscurance(scene, ORIGIN, &options, rgb);
    ASSERT_NEAR(rgb[1], 1.0 - f + f * (double)COLOR[1], TOLERANCE);
    alp_scene_destroy(scene);
}

static alp_scene *near_wall(const float color[3])
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){1, 0, -FAR}, (double[]){0, 0, 2 * FAR}, (double[]){0, FAR, 0});
    return colored_scene(mesh, color, true);
}

static double accessibility(const alp_scene *scene, const alp_occlusion_options *options)
{
    return test_occlusion(scene, ORIGIN, UP, options);
}

TEST(black_surfaces_only_occlude)
{
    alp_scene *black = near_wall(BLACK), *colored = near_wall(COLOR);
    alp_occlusion_options options = open_options();
    for (int falloff = ALP_FALLOFF_NONE; falloff <= ALP_FALLOFF_EXP; falloff++) {
        options.falloff = (alp_falloff)falloff;
        options.distance = 2.5f;
        const double open = accessibility(black, &options);
        double rgb[3];
        obscurance(black, ORIGIN, &options, rgb);
        for (int c = 0; c < 3; c++) { // without a fall-off the same rays: the same number
            ASSERT_NEAR(rgb[c], open, falloff == ALP_FALLOFF_NONE ? 1e-6 : TOLERANCE);
        }
        obscurance(colored, ORIGIN, &options, rgb); // W = A + (1 − A) ρ
        for (int c = 0; c < 3; c++) {
            ASSERT_NEAR(rgb[c], open + (1.0 - open) * (double)COLOR[c], TOLERANCE);
        }
    }
    alp_scene_destroy(black);
    alp_scene_destroy(colored);
}

TEST(cornell_walls_bleed)
{
    // The red wall stands at x ≈ .55 m, the green one at 0.
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_occlusion_options options = open_options();
    double at_red[3], at_green[3];
    obscurance(scene, (double[]){0.53, 0, 0.1}, &options, at_red);
    obscurance(scene, (double[]){0.02, 0, 0.3}, &options, at_green);
    assert_true(at_red[0] > at_red[1] + 0.1 && at_red[0] > at_red[2] + 0.1);
    assert_true(at_green[1] > at_green[0] + 0.1 && at_green[1] > at_green[2] + 0.1);
    alp_scene_destroy(scene);
}

// --- bits ----------------------------------------------------------------------------------------

enum { POINTS = 2500 };

static void gather(uint32_t workers, uint64_t seed, float values[2][POINTS][3])
{
    static float positions[POINTS][3], normals[POINTS][3];
    alp_context *own = test_context(workers);
    alp_scene *scene = test_load(own, "builtin:cornell");
    for (int i = 0; i < POINTS; i++) {
        positions[i][0] = 0.05f + 0.45f * (float)(i % 50) / 50.0f;
        positions[i][1] = 0.0f;
        positions[i][2] = 0.05f + 0.45f * (float)(i / 50) / 50.0f;
        normals[i][0] = normals[i][2] = 0.0f;
        normals[i][1] = 1.0f;
    }
    alp_occlusion_options options = alp_occlusion_options_default();
    options.samples = 64;
    options.seed = seed;
    ASSERT_OK(own, alp_obscurance_at_points(scene, POINTS, positions[0], NULL, normals[0], &options,
                                            values[0][0]));
    ASSERT_OK(own, alp_bent_normals_at_points(scene, POINTS, positions[0], NULL, normals[0],
                                              &options, values[1][0]));
    alp_scene_destroy(scene);
    alp_context_destroy(own);
}

TEST(workers_change_no_bit_and_seeds_do)
{
    static float one[2][POINTS][3], other[2][POINTS][3];
    const uint32_t workers[] = {2, 7, 32};
    gather(1, 5, one);
    for (size_t i = 0; i < sizeof workers / sizeof *workers; i++) {
        memset(other, 0, sizeof other);
        gather(workers[i], 5, other);
        assert_memory_equal(one, other, sizeof one);
    }
    gather(2, 6, other);
    for (int map = 0; map < 2; map++) {
        int different = 0;
        for (int i = 0; i < POINTS; i++) {
            different += one[map][i][0] != other[map][i][0] || one[map][i][1] != other[map][i][1] ||
                         one[map][i][2] != other[map][i][2];
        }
        assert_true(different > POINTS / 10);
    }
}

TEST(many_samples_add_up)
{
    // More than one round holds; and a number that is no multiple of four.
    alp_scene *scene = near_wall(COLOR);
    alp_occlusion_options options = open_options();
    options.samples = (1u << 15) + 4321;
    double rgb[3];
    obscurance(scene, ORIGIN, &options, rgb);
    ASSERT_NEAR(rgb[0], 0.5 + 0.5 * (double)COLOR[0], TOLERANCE);
    alp_scene_destroy(scene);
}

TEST(bad_arguments_are_refused)
{
    alp_scene *scene = near_wall(COLOR);
    const float p[3] = {0, 0, 0}, n[3] = {0, 1, 0}, longer[3] = {0, 1.1f, 0};
    float out[3] = {7, 7, 7};
    assert_int_equal(alp_obscurance_at_points(scene, 1, p, NULL, longer, NULL, out),
                     ALP_ERROR_INVALID_DATA);
    assert_int_equal(alp_bent_normals_at_points(scene, 1, p, NULL, longer, NULL, out),
                     ALP_ERROR_INVALID_DATA);
    assert_int_equal(alp_obscurance_at_points(scene, 1, NULL, NULL, n, NULL, out),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_bent_normals_at_points(scene, 1, p, NULL, n, NULL, NULL),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_true(out[0] == 7.0f && out[2] == 7.0f);
    ASSERT_OK(context, alp_obscurance_at_points(scene, 0, NULL, NULL, NULL, NULL, NULL));
    ASSERT_OK(context, alp_bent_normals_at_points(scene, 0, NULL, NULL, NULL, NULL, NULL));
    alp_scene_destroy(scene);
}
