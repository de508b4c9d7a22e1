// SPDX-License-Identifier: MIT
// The first round of light sends the rays that its error asks for: a few texels try before how
// noisy it is.
#include "bake/light_next.h"
#include "test_scenes.h"

#include <math.h>

static alp_context *context;

static int setup(void **state)
{
    (void)state;
    context = test_context(2);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    alp_context_destroy(context);
    return 0;
}

/// @param time_limit s, that no bake here takes; with one no texels try, and rounds begin with few
///                   rays
static alp_bake_report bake(float error, double time_limit, uint64_t seed)
{
    alp_scene *scene = NULL;
    alp_lightmap *map = NULL;
    alp_bake_report report;
    alp_bake_options options = alp_bake_options_default();
    ASSERT_OK(context, alp_scene_load(context, "builtin:cornell", &scene));
    options.atlas.size = 256;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.maps = ALP_MAP_LIGHT;
    options.light.error = error;
    options.sampling.time_limit = time_limit;
    options.occlusion.seed = seed;
    ASSERT_OK(context, alp_bake(scene, &options, &map, &report));
    print_message("for %.1f %%%s: %u rays of a texel, %.2f %% stated, %.2f Mrays\n",
                  100.0 * (double)error, time_limit > 0.0 ? " within a time" : "",
                  report.light_samples, 100.0 * report.light_relative_error,
                  (double)report.rays * 1e-6);
    alp_lightmap_destroy(map);
    alp_scene_destroy(scene);
    return report;
}

static void few_rays_do_for_a_large_error(void **state)
{
    (void)state;
    assert_int_equal(bake(0.2f, 0.0, 0).light_samples, ALPI_LIGHT_FIRST_RAYS);
}

/// Rays that a bake would have taken, had it come to an error by the way: see radiosity.c.
static double rays_for(const alp_bake_report *report, double error)
{
    return (double)report->rays * pow(report->light_relative_error / error, 1.6);
}

/// Not far less than was asked for, and with fewer rays than rounds take that begin with few.
static void the_first_round_is_the_last(void **state)
{
    (void)state;
    static const float errors[] = {0.02f, 0.01f};
    enum { ERRORS = sizeof errors / sizeof *errors, SEEDS = 3 };
    double gain = 1.0;
    for (int i = 0; i < ERRORS * SEEDS; i++) {
        const float error = errors[i / SEEDS];
        const alp_bake_report one = bake(error, 0.0, (uint64_t)(i % SEEDS));
        const alp_bake_report rounds = bake(error, 1e6, (uint64_t)(i % SEEDS));
        assert_true(one.light_relative_error <= (double)error);
        assert_true(one.light_relative_error >= 0.6 * (double)error);
        gain *= pow(rays_for(&rounds, (double)error) / rays_for(&one, (double)error),
                    1.0 / (ERRORS * SEEDS));
    }
    print_message("rounds that begin with few rays: %.2f times as many in the mean\n", gain);
    assert_true(gain > 1.1);
}

/// Further rounds do what is left to do, where one would take more rays than the first may send.
static void rounds_follow_for_a_small_error(void **state)
{
    (void)state;
    const alp_bake_report report = bake(0.004f, 0.0, 0);
    assert_true(report.light_samples > 1024);
    assert_true(report.light_relative_error <= 0.004);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_rays_do_for_a_large_error),
        cmocka_unit_test(the_first_round_is_the_last),
        cmocka_unit_test(rounds_follow_for_a_small_error),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
