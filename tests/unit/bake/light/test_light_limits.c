// SPDX-License-Identifier: MIT
// Limits of a bake of light: time, and someone who ends it.
#include "test_scenes.h"

#include <math.h>
#include <string.h>

enum { SIZE = 64 };

/// A map of light that is whole: known, not negative, not black.
static void check_map(const alp_lightmap *lightmap, const alp_bake_report *report)
{
    uint32_t width, height;
    const float *page = alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, 0, &width, &height);
    double sum = 0.0;
    for (size_t i = 0; i < (size_t)4 * width * height; i++) {
        assert_true(isfinite(page[i]) && page[i] >= 0.0f);
        sum += (double)page[i];
    }
    assert_true(sum > 0.0 && report->light_mean > 0.0);
    assert_true(report->light_relative_error > 0.0);
}

TEST_WITH_CONTEXT(time_limit_ends_with_whole_rounds, 2)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    for (int both = 0; both < 2; both++) {
        alp_bake_options options = test_light_options(SIZE);
        options.maps |= both ? ALP_MAP_AO : 0u;
        options.occlusion.samples = 65536;
        options.sampling.time_limit = 0.2;
        alp_lightmap *lightmap = NULL;
        alp_bake_report report;
        alp_result result = alp_bake(scene, &options, &lightmap, &report);
        while (result == ALP_ERROR_LIMIT) { // a machine too slow for a round in that time
            options.sampling.time_limit *= 2.0;
            result = alp_bake(scene, &options, &lightmap, &report);
        }
        ASSERT_OK(context, result);
        assert_true(report.cut_off);
        assert_true(report.light_samples >= 64 && report.light_samples < 65536);
        check_map(lightmap, &report);
        alp_lightmap_destroy(lightmap);
    }
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(no_time_is_no_light, 2)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_bake_options options = test_light_options(512);
    options.sampling.time_limit = 1e-9;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_LIMIT);
    assert_non_null(strstr(alp_context_message(context), "time limit"));
    options.light.gather = ALP_GATHER_HEMICUBE; // in one go
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    alp_scene_destroy(scene);
}

/// A map that nothing lights is black, and is refused before the work. Lamps of 0
/// candela and a sky of strength 0 give no light.
TEST_WITH_CONTEXT(darkness_is_refused, 1)
{
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_lamp lamp = alp_lamp_default();
    alp_bake_options o = test_light_options(16);
    o.light.lighting.lamps = &lamp;
    o.light.lighting.lamp_count = 1;
    for (int both = 0; both < 2; both++) {
        o.maps |= both ? ALP_MAP_AO : 0u;
        assert_int_equal(alp_bake(scene, &o, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
        assert_non_null(strstr(alp_context_message(context), "--sky 1,1,1"));
    }
    o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
    o.light.lighting.sky.strength = 0.0f;
    assert_int_equal(alp_bake(scene, &o, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    alp_bake_work work;
    ASSERT_OK(context, alp_bake_estimate(scene, &o, &work)); // light may still come
    o.light.lighting.sky.strength = 1.0f;
    ASSERT_OK(context, alp_bake(scene, &o, NULL, NULL));
    o.light.lighting.sky.kind = ALP_SKY_NONE;
    lamp.position[1] = 3.0f;
    lamp.intensity = 1.0f;
    ASSERT_OK(context, alp_bake(scene, &o, NULL, NULL));
    o.maps = ALP_MAP_AO; // occlusion needs no light
    lamp.intensity = 0.0f;
    ASSERT_OK(context, alp_bake(scene, &o, NULL, NULL));
    alp_scene_destroy(scene);
}

/// Refuses when it is asked the `left`-th time in the light, and must not be asked then again.
typedef struct impatience {
    int left;
    double share; // of the light, as told last
} impatience;

static bool lose_patience(void *user, const alp_progress *progress)
{
    impatience *i = user;
    if (strcmp(progress->stage, "light") == 0) {
        const double share = (double)progress->done / (double)progress->total;
        assert_true(i->left > 0);
        assert_true(share >= i->share && share <= 1.0); // it never goes back
        i->share = share;
        i->left--;
    }
    return i->left > 0;
}

TEST_WITH_CONTEXT(what_is_cancelled_may_be_kept, 2)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_bake_options options = test_light_options(SIZE);
    impatience i = {.left = 40}; // 20 times a second
    options.progress = lose_patience;
    options.progress_user = &i;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_CANCELLED);
    options.sampling.keep_partial = true;
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    alp_result result = ALP_ERROR_CANCELLED;
    for (int left = 80; result == ALP_ERROR_CANCELLED && left < 10000; left *= 2) {
        i = (impatience){.left = left}; // until the first round comes to its end before
        result = alp_bake(scene, &options, &lightmap, &report);
    }
    ASSERT_OK(context, result);
    assert_true(report.cut_off);
    check_map(lightmap, &report);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

/// Refuses the `left`-th time it is told of a stage.
typedef struct distaste {
    const char *stage;
    int left;
} distaste;

static bool dislike(void *user, const alp_progress *progress)
{
    distaste *d = user;
    assert_true(d->left > 0); // nobody who refused is asked again
    d->left -= strcmp(progress->stage, d->stage) == 0;
    return d->left > 0;
}

/// The map before noise is taken off is whole: it is kept, bit by bit, and it is said which it is.
TEST_WITH_CONTEXT(light_that_is_not_denoised_is_kept, 2)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_bake_options options = test_light_options(SIZE);
    options.light.samples = TEST_STEP > 1 ? 16 : 128;
    options.sampling.keep_partial = true;
    options.sampling.accuracy = ALP_ADAPTIVE_OFF; // as what is to be denoised
    uint32_t width, height;
    alp_lightmap *before = NULL, *after = NULL, *kept = NULL;
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, &before, NULL));
    options.light.denoise = true;
    ASSERT_OK(context, alp_bake(scene, &options, &after, &report));
    assert_false(report.cut_off);
    test_log_clear();
    distaste d = {.stage = "denoise", .left = 1};
    options.progress = dislike;
    options.progress_user = &d;
    ASSERT_OK(context, alp_bake(scene, &options, &kept, &report));
    assert_true(report.cut_off && d.left == 0);
    assert_true(test_log_has("not-denoised"));
    check_map(kept, &report);
    const float *pages[] = {alp_lightmap_map_page(before, ALP_MAP_LIGHT, 0, &width, &height),
                            alp_lightmap_map_page(kept, ALP_MAP_LIGHT, 0, &width, &height),
                            alp_lightmap_map_page(after, ALP_MAP_LIGHT, 0, &width, &height)};
    const size_t size = (size_t)4 * width * height * sizeof *pages[0];
    assert_memory_equal(pages[0], pages[1], size);
    assert_true(memcmp(pages[1], pages[2], size) != 0);
    d.left = 1;
    options.sampling.keep_partial = false;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_CANCELLED);
    alp_lightmap_destroy(before);
    alp_lightmap_destroy(after);
    alp_lightmap_destroy(kept);
    alp_scene_destroy(scene);
}
