// SPDX-License-Identifier: MIT
// Ambience sampled in a scene with fewer triangles.
#include "ambience_world.h"

TEST_CONTEXT(2);

enum { POINTS = 16 };

/// E from above at points round the middle of a landscape, with rays that meet `detail`.
static void measure(const alp_scene *scene, float detail, double e[POINTS])
{
    const alp_ambience_camera camera = {.position = {0.0, 22.0, 0.0}};
    alp_ambience_options a = alp_ambience_options_default();
    alp_ambience_sampler_options o = alp_ambience_sampler_options_default();
    alp_ambience *ambience = NULL;
    alp_ambience_sampler *sampler = NULL;
    a.depth = 3;
    o.lighting.sky.kind = ALP_SKY_CLEAR;
    o.lighting.sun.elevation = 0.8f;
    o.lighting.sun.illuminance = 1e5f;
    o.detail = detail;
    ASSERT_OK(context, alp_ambience_create(context, &a, &ambience));
    ASSERT_OK(context, alp_ambience_sampler_create(ambience, scene, &o, &sampler));
    for (int i = 0; i < 2; i++) {
        ASSERT_OK(context, alp_ambience_update(ambience, 0.0));
        ASSERT_OK(context, alp_ambience_sample(sampler, &camera, 2000, 0.0, NULL));
    }
    ASSERT_OK(context, alp_ambience_update(ambience, 0.0));
    const alp_ambience_snapshot *now = alp_ambience_begin_read(ambience);
    for (int i = 0; i < POINTS; i++) {
        const double place[1][3] = {{4.0 * (i % 4) - 6.0, 22.0, 4.0 * (i / 4) - 6.0}};
        const float down[1][3] = {{0.0f, -1.0f, 0.0f}};
        float light[1][3];
        alp_ambience_irradiance(now, 1, place, down, light);
        e[i] = (double)light[0][1];
    }
    alp_ambience_end_read(ambience, now);
    alp_ambience_sampler_destroy(sampler);
    alp_ambience_destroy(ambience);
}

TEST(a_simple_scene_gives_about_the_same_light)
{
    alp_scene *scene = test_load(context, "builtin:terrain,triangles=20000");
    double whole[POINTS], simple[POINTS], apart = 0.0, sum = 0.0;
    measure(scene, 0.0f, whole);
    measure(scene, 1.0f, simple);
    for (int i = 0; i < POINTS; i++) {
        assert_true(whole[i] > 0.0);
        apart += fabs(simple[i] - whole[i]);
        sum += whole[i];
    }
    print_message("%.2f %% apart\n", 100.0 * apart / sum);
    assert_true(apart > 0.0 && apart < 0.05 * sum);
    alp_scene_destroy(scene);
}

TEST(details_that_are_none_are_refused)
{
    static const float bad[] = {-1.0f, NAN, INFINITY};
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_ambience *a = world_open(context, NULL);
    for (int i = 0; i < 3; i++) {
        alp_ambience_sampler_options o = alp_ambience_sampler_options_default();
        alp_ambience_sampler *sampler = NULL;
        o.detail = bad[i];
        assert_int_equal(alp_ambience_sampler_create(a, scene, &o, &sampler),
                         ALP_ERROR_INVALID_ARGUMENT);
        assert_null(sampler);
    }
    alp_ambience_destroy(a);
    alp_scene_destroy(scene);
}
