// SPDX-License-Identifier: MIT
// Rounds of a number of rays that is given, where someone may end them.
#include "test_scenes.h"

enum { SIZE = 64 };

/// Rounds that double until the samples are there have the same mean as one round of them.
TEST_WITH_CONTEXT(rounds_agree_with_one, 2)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_bake_options options = test_light_options(SIZE);
    options.light.samples = 256;
    alp_bake_report once, rounds;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &once));
    options.sampling.keep_partial = true;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &rounds));
    assert_false(rounds.cut_off);
    assert_true(rounds.light_samples <= 256 && rounds.light_samples > 64);
    // Means over thousands of texels of some per cent each; what blocks share is within them.
    ASSERT_NEAR(rounds.light_mean / once.light_mean, 1.0, 0.005);
    alp_scene_destroy(scene);
}

/// Rounds add up to the number of rays that is given.
TEST_SLOW_WITH_CONTEXT(rounds_send_what_is_given, 2)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_bake_options options = test_light_options(40);
    options.sampling.keep_partial = true;
    static const uint32_t given[] = {672, 1440, 1728, 2784};
    for (size_t i = 0; i < sizeof given / sizeof *given; i++) {
        alp_bake_report report;
        options.light.samples = given[i];
        ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
        print_message("%u rays given, %u sent\n", given[i], report.light_samples);
        assert_int_equal(report.light_samples, given[i]);
    }
    alp_scene_destroy(scene);
}
