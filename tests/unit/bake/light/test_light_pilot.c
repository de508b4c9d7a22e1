// SPDX-License-Identifier: MIT
// The first round of light sends the rays that its error asks for: a few texels try before how
// noisy it is.
#include "bake/light/light_gather.h"
#include "test_scenes.h"

TEST_CONTEXT(2);

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
    print_message("for %.1f %%%s: %u rays of a texel in %u rounds, %.2f %% stated\n",
                  100.0 * (double)error, time_limit > 0.0 ? " within a time" : "",
                  report.light_samples, report.light_rounds, 100.0 * report.light_relative_error);
    alp_lightmap_destroy(map);
    alp_scene_destroy(scene);
    return report;
}

/// Packets in equal replicates, few enough over what is asked.
TEST(rays_make_replicates)
{
    enum { STEP = ALPI_LIGHT_REPLICATES * ALPI_PACKET };
    for (uint32_t asked = 0; asked <= 5000; asked++) {
        const uint32_t rays = alpi_light_ray_count((double)asked);
        assert_true(rays > 0 && rays % STEP == 0);
        assert_true(rays >= asked && (rays == STEP || rays < asked + STEP));
    }
    assert_int_equal(alpi_light_ray_count(64.25), 96);
}

TEST(few_rays_do_for_a_large_error)
{
    const alp_bake_report fewest = bake(0.2f, 0.0, 0);
    assert_int_equal(fewest.light_samples, ALPI_LIGHT_FIRST_RAYS);
    const alp_bake_report report = bake(0.04f, 0.0, 0);
    assert_true(report.light_samples >= ALPI_LIGHT_FIRST_RAYS && report.light_samples <= 96);
    assert_true(report.light_relative_error <= 0.04 && report.light_rounds == 1);
    // The mean is that of many rays.
    const double mean = bake(0.02f, 0.0, 0).light_mean;
    print_message("means %.5f %.5f %.5f\n", fewest.light_mean, report.light_mean, mean);
    assert_true(fabs(fewest.light_mean - mean) <= 0.005 * mean);
    assert_true(fabs(report.light_mean - mean) <= 0.005 * mean);
}

/// Nor is it far better than was asked for. Where it falls short by a little, one more follows: for
/// 2 % in one of three at most.
TEST_SLOW(the_first_round_is_the_last)
{
    static const float errors[] = {0.02f, 0.01f};
    enum { SEEDS = 3 };
    uint32_t first_only = 0; // for 2 %
    for (uint32_t i = 0; i < 2 * SEEDS; i++) {
        const double error = (double)errors[i / SEEDS];
        const alp_bake_report r = bake(errors[i / SEEDS], 0.0, i % SEEDS);
        assert_true(r.light_relative_error <= error && r.light_relative_error >= 0.65 * error);
        assert_true(r.light_rounds <= 2);
        first_only += i < SEEDS && r.light_rounds == 1 ? 1 : 0;
    }
    assert_true(first_only >= SEEDS - 1);
    assert_true(bake(0.02f, 1e6, 0).light_rounds > 1);
}

/// Further rounds do what is left to do, where one would take more rays than the first may send.
TEST_SLOW(rounds_follow_for_a_small_error)
{
    const alp_bake_report report = bake(0.0035f, 0.0, 0);
    assert_true(report.light_samples > 1024 && report.light_rounds > 1);
    assert_true(report.light_relative_error <= 0.0035);
}

/// Calls that are answered yes.
static bool goes_on(void *user, const alp_progress *progress)
{
    (void)progress;
    int *left = user;
    return --*left > 0;
}

/// Wherever in a bake with a trial; leaks are the sanitizer's to see.
TEST(it_can_be_cancelled)
{
    alp_scene *scene = NULL;
    alp_bake_options options = alp_bake_options_default();
    int left = 0;
    ASSERT_OK(context, alp_scene_load(context, "builtin:cornell", &scene));
    options.atlas.size = 128;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.maps = ALP_MAP_LIGHT;
    options.light.error = 0.03f;
    options.progress = goes_on;
    options.progress_user = &left;
    alp_result result = ALP_ERROR_CANCELLED;
    int cancelled = 0;
    for (int calls = 10; result == ALP_ERROR_CANCELLED; calls += calls / 8 + 1) {
        left = calls;
        result = alp_bake(scene, &options, NULL, NULL);
        cancelled += result == ALP_ERROR_CANCELLED ? 1 : 0;
    }
    assert_int_equal(result, ALP_OK);
    print_message("cancelled %d times\n", cancelled);
    assert_true(cancelled > 5);
    alp_scene_destroy(scene);
}
