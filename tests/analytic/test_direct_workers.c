// SPDX-License-Identifier: MIT
// Direct light has the same bits for any number of workers, and the same means whatever else is in
// the list; it ends soon after it is cancelled, within one receiver too. It tells what a sample
// takes.
#include "base/image.h"
#include "scene/sky/sky.h"
#include "test_direct_stage.h"

#include <stdlib.h>

enum { POINTS = 32, PARTS = 3 };
static test_patch patches[POINTS];

typedef struct result {
    alpi_reference_value values[POINTS], parts[POINTS][PARTS];
} result;

/// With a lamp. @param lighting NULL: of an even sky
static test_stage open_cornell(alp_context *context, const alp_lighting_options *lighting)
{
    alp_scene *scene = NULL;
    const alpi_light lamp = test_lamp((vec3){0.2f, 0.3f, -0.2f}, 0.1f);
    alp_lighting_options even = alp_lighting_options_default();
    even.sky.kind = ALP_SKY_CONSTANT;
    ASSERT_OK(context, alp_scene_load(context, "builtin:cornell", &scene));
    return test_stage_open(context, scene, &lamp, 1, lighting != NULL ? lighting : &even);
}

static test_patches floor_patches(void)
{
    for (uint32_t i = 0; i < POINTS; i++) {
        patches[i] = (test_patch){
            {0.05f + 0.014f * (float)i, 0.0f, -0.4f}, {0.014f, 0, 0}, {0, 0, 0.014f}, {0, 1, 0}};
    }
    return (test_patches){.count = POINTS, .patches = patches, .offset = 1e-6f};
}

static void gather(const test_stage *stage, uint32_t workers, const uint32_t *list,
                   uint32_t list_count, result *made)
{
    alp_context *context = test_context(workers);
    alpi_direct_options o = test_stage_options(stage, 100); // rounded up to 104
    o.context = context;
    const test_patches floor = floor_patches();
    const alpi_receivers receivers = test_patches_receivers(&floor);
    alpi_direct *direct = NULL;
    uint32_t parts;
    alpi_direct_output output = {.values = made->values, .parts = made->parts[0]};
    ASSERT_OK(context, alpi_direct_create(&o, &direct));
    alpi_direct_parts(direct, &parts);
    assert_int_equal(parts, PARTS);
    ASSERT_OK(context, alpi_direct_irradiance(direct, &receivers, list, list_count, NULL, &output));
    alpi_direct_destroy(direct);
    alp_context_destroy(context);
}

static void gather_all(uint32_t workers, const void *stage, void *made)
{
    gather(stage, workers, NULL, 0, made);
}

TEST_WITH_CONTEXT(workers_change_nothing, 1)
{
    static result listed;
    test_stage stage = open_cornell(context, NULL);
    result *all = test_any_workers(gather_all, &stage, sizeof *all);
    assert_true(all->values[7].mean[0] > 0.0f && all->values[7].variance[0] > 0.0f);
    const uint32_t some[2] = {7, 3};
    gather(&stage, 2, some, 2, &listed);
    for (int i = 0; i < 2; i++) {
        const uint32_t t = some[i]; // their variances are scaled by what all of a list tell
        assert_memory_equal(listed.values[t].mean, all->values[t].mean, sizeof all->values[0].mean);
        for (int p = 0; p < PARTS; p++) {
            assert_memory_equal(listed.parts[t][p].mean, all->parts[t][p].mean,
                                sizeof all->parts[0][0].mean);
        }
    }
    assert_true(listed.values[5].mean[0] == 0.0f); // not in the list
    free(all);
    test_stage_close(&stage);
}

/// A picture of a sky: every fifth pixel is bright.
static alp_image *bright_pixels(alp_context *context)
{
    enum { WIDTH = 64, HEIGHT = 32 };
    const alp_image_info info = {WIDTH, HEIGHT, 3, ALP_COMPONENT_FLOAT};
    alp_image *picture = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &picture));
    for (uint32_t i = 0; i < WIDTH * HEIGHT * 3; i++) {
        alp_image_floats(picture)[i] = i / 3 % 5 == 0 ? 40.0f : 0.1f;
    }
    return picture;
}

/// The box's own lamp is a polygon, and what comes in by its open side spots of a sky: of variances
/// a part is scaled by what all receivers tell.
TEST_WITH_CONTEXT(nor_with_spots, 1)
{
    alp_lighting_options o = alp_lighting_options_default();
    alp_image *picture = bright_pixels(context);
    o.sky.kind = ALP_SKY_IMAGE;
    o.sky.image = picture;
    test_stage stage = open_cornell(context, &o);
    alpi_lighting *whole = stage.lighting, *soft = NULL;
    ASSERT_OK(context, alpi_lighting_split_sky(whole, &o, &soft, &stage.lighting));
    assert_non_null(alpi_sky_spot_looks(alpi_lighting_sky(stage.lighting)));
    result *all = test_any_workers(gather_all, &stage, sizeof *all);
    for (int p = 0; p < PARTS; p++) {
        assert_true(all->parts[POINTS - 1][p].mean[0] > 0.0f);
    }
    assert_true(all->values[POINTS - 1].variance[0] > 0.0f);
    free(all);
    alpi_lighting_destroy(context, soft);
    alpi_lighting_destroy(context, whole);
    test_stage_close(&stage);
    alp_image_destroy(picture);
}

/// What the user hears, and when the answer is no.
typedef struct listener {
    uint32_t calls, refuse_at;
    uint64_t done, total;
    bool backwards;
} listener;

static bool listen(void *user, const alp_progress *progress)
{
    listener *l = user;
    l->backwards = l->backwards || progress->done < l->done || progress->done > progress->total;
    l->done = progress->done;
    l->total = progress->total;
    return ++l->calls != l->refuse_at;
}

TEST(one_receiver_can_be_cancelled)
{
    // 2^26 samples of one receiver take minutes.
    for (uint32_t workers = 1; workers <= 2; workers++) {
        alp_context *context = test_context(workers);
        test_stage stage = open_cornell(context, NULL);
        alpi_direct_options o = test_stage_options(&stage, 1u << 26);
        const test_patches floor = floor_patches();
        const alpi_receivers receivers = test_patches_receivers(&floor);
        static alpi_reference_value values[POINTS];
        alpi_direct_output output = {.values = values};
        alpi_direct *direct = NULL;
        listener l = {.refuse_at = 3};
        const alpi_task_progress told = {.callback = listen, .user = &l, .stage = "light"};
        ASSERT_OK(context, alpi_direct_create(&o, &direct));
        const double started = alpi_seconds();
        assert_int_equal(alpi_direct_irradiance(direct, &receivers, NULL, 0, &told, &output),
                         ALP_ERROR_CANCELLED);
        // Asked at once and twice more, every 50 ms; the rest is for a machine that is busy.
        assert_true(alpi_seconds() - started < 2.0);
        assert_int_equal(l.calls, 3); // who refused is not asked again
        assert_false(l.backwards);
        alpi_direct_destroy(direct);
        test_stage_close(&stage);
        alp_context_destroy(context);
    }
}

/// Rays are counted as they are traced, and progress ends at its total.
TEST_WITH_CONTEXT(counts_are_true, 2)
{
    test_stage stage = open_cornell(context, NULL);
    const alpi_direct_options o = test_stage_options(&stage, 64);
    const test_patches floor = floor_patches();
    const alpi_receivers receivers = test_patches_receivers(&floor);
    static alpi_reference_value values[POINTS];
    alpi_direct_output output = {.values = values, .rays = 5}; // added to
    alpi_direct *direct = NULL;
    listener l = {0};
    const alpi_task_progress told = {.callback = listen, .user = &l, .stage = "light"};
    ASSERT_OK(context, alpi_direct_create(&o, &direct));
    ASSERT_OK(context, alpi_direct_irradiance(direct, &receivers, NULL, 0, &told, &output));
    assert_true(l.done == l.total && !l.backwards);
    // The lamp, the quad with its scouts, and the even sky: all points see the first two, of which
    // none is below their horizon; who sees all of the quad asks a quarter as often.
    assert_int_equal(l.total, (3 * 64 + 1) * POINTS);
    assert_in_range(output.rays - 5, (2 * 64 + 16 + 1) * POINTS, (3 * 64 + 1) * POINTS - 1);
    alpi_direct_destroy(direct);
    test_stage_close(&stage);
}

/// Of lamps enough to be drawn, emitters and a sky.
TEST(every_allocation_may_fail)
{
    enum { LAMPS = 80 };
    int left = 0;
    alp_context *context = test_context_failing(&left);
    left = 1 << 30;
    alpi_light lamps[LAMPS];
    for (int i = 0; i < LAMPS; i++) {
        lamps[i] = test_lamp((vec3){0.005f * (float)i, 0.3f, -0.2f}, 0.1f);
    }
    alp_scene *scene = test_load(context, "builtin:cornell");
    test_stage stage = test_stage_open(context, scene, lamps, LAMPS, NULL);
    const alpi_direct_options o = test_stage_options(&stage, 8);
    alpi_direct *direct = NULL;
    left = 1 << 30;
    ASSERT_OK(context, alpi_direct_create(&o, &direct));
    alpi_direct_destroy(direct);
    const int needed = (1 << 30) - left;
    assert_true(needed > 8);
    for (int i = 0; i < needed; i++) {
        left = i;
        assert_int_equal(alpi_direct_create(&o, &direct), ALP_ERROR_OUT_OF_MEMORY);
        assert_null(direct);
    }
    left = 1 << 30;
    test_stage_close(&stage);
    alp_context_destroy(context);
}

/// In plain shadow rays: one; two of an uneven sky; of listed triangles by their number.
TEST(the_time_of_a_sample_is_told)
{
    const struct {
        const char *scene;
        alp_sky_kind sky;
        double draw;
    } cases[] = {{"builtin:cornell", ALP_SKY_NONE, 1.0}, // 2 emissive triangles
                 {"builtin:sphere-plane", ALP_SKY_CONSTANT, 1.0},
                 {"builtin:sphere-plane", ALP_SKY_IMAGE, 2.0},
                 {"builtin:windows", ALP_SKY_NONE, 1.0 + 0.008 * 528},
                 {"builtin:windows", ALP_SKY_IMAGE, 1.0 + 0.008 * 528}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = NULL;
        alp_lighting_options lighting = alp_lighting_options_default();
        alp_image *picture = bright_pixels(context);
        lighting.sky.kind = cases[i].sky;
        lighting.sky.image = cases[i].sky == ALP_SKY_IMAGE ? picture : NULL;
        ASSERT_OK(context, alp_scene_load(context, cases[i].scene, &scene));
        test_stage stage = test_stage_open(context, scene, NULL, 0, &lighting);
        const alpi_direct_options o = test_stage_options(&stage, 8);
        const test_patches floor = floor_patches();
        const alpi_receivers receivers = test_patches_receivers(&floor);
        alpi_reference_value values[POINTS];
        alpi_direct_output output = {.values = values};
        alpi_direct *direct = NULL;
        ASSERT_OK(context, alpi_direct_create(&o, &direct));
        ASSERT_OK(context, alpi_direct_irradiance(direct, &receivers, NULL, 0, NULL, &output));
        ASSERT_NEAR(output.draw, cases[i].draw, 1e-12);
        alpi_direct_destroy(direct);
        test_stage_close(&stage);
        alp_image_destroy(picture);
        alp_context_destroy(context);
    }
}
