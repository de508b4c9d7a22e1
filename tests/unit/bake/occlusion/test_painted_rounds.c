// SPDX-License-Identifier: MIT
// Which texels are traced and with how many samples, on maps whose every value is chosen: receivers
// of a texel lie above a floor, where all is open, or just below it, where nothing is.
#include "bake/occlusion/occlusion_rounds.h"
#include "base/context.h"
#include "base/random.h"
#include "test_scenes.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 64, SAMPLES = 64 };
typedef enum paint { OPEN = 0, DARK, MIXED } paint;
static const float MIXED_VALUE = 0.63f; // on no dyadic line: estimates of it have an error

typedef struct painting {
    alp_context *context;
    alp_scene *scene;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_lattice lattice;
    alpi_receivers receivers;
    alp_occlusion_options options;
    uint8_t *paints; // [texels]
    float *errors;   // [texels]
} painting;

static void place(const void *user, uint32_t receiver, uint32_t count, const float (*square)[2],
                  alpi_receiver_point *points)
{
    const painting *s = user;
    const vec3 up = {0.0f, 1.0f, 0.0f}, above = {1.0f, 1.0f, 1.0f}, below = {1.0f, -1e-4f, 1.0f};
    for (uint32_t i = 0; i < count; i++) {
        const paint p = (paint)s->paints[receiver];
        const bool dark = p == DARK || (p == MIXED && square[i][0] >= MIXED_VALUE);
        points[i] = (alpi_receiver_point){dark ? below : above, up, up, 0.0f};
    }
}

/// A floor of one chart, all open.
static void set_up(painting *s)
{
    *s = (painting){.context = test_context(2)};
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){0, 0, 2}, (double[]){2, 0, 0});
    s->scene = test_mesh_scene(s->context, mesh, 1);
    alp_atlas_options atlas = alp_atlas_options_default();
    atlas.size = SIZE;
    ASSERT_OK(s->context, alp_atlas_create(s->scene, &atlas, &s->atlas));
    ASSERT_OK(s->context, alpi_texels_create(s->atlas, &s->texels));
    ASSERT_OK(s->context, alpi_lattice_create(s->atlas, &s->texels, &s->lattice));
    s->options = alp_occlusion_options_default();
    s->options.samples = SAMPLES;
    s->options.distance = INFINITY;
    s->paints = calloc(s->texels.count, sizeof *s->paints);
    s->errors = calloc(s->texels.count, sizeof *s->errors);
    assert_true(s->paints != NULL && s->errors != NULL);
    s->receivers = (alpi_receivers){s->texels.count, true, place, s};
}

static void tear_down(painting *s)
{
    free(s->paints);
    free(s->errors);
    alpi_lattice_destroy(&s->lattice);
    alpi_texels_destroy(s->context, &s->texels);
    alp_atlas_destroy(s->atlas);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

/// @param options accuracy and what ends the rounds
static alp_result run(painting *s, const alpi_occlusion_task *options,
                      alpi_occlusion_report *report)
{
    alpi_tracer *tracer = NULL;
    alpi_occlusion_setup setup;
    ASSERT_OK(s->context, alpi_tracer_for_scene(s->scene, NULL, NULL, &tracer, NULL));
    ASSERT_OK(s->context, alpi_occlusion_prepare(s->scene, tracer, &s->options, &setup));
    memset(s->lattice.states, 0, s->texels.count);
    memset(s->lattice.values, 0, s->texels.count * sizeof *s->lattice.values);
    alpi_scratch scratch;
    alpi_occlusion_task task = *options;
    task.setup = &setup;
    task.receivers = &s->receivers;
    task.order = s->lattice.order;
    task.count = s->texels.count;
    task.lattice = &s->lattice;
    task.errors = s->errors;
    task.scratch = &scratch;
    ASSERT_OK(s->context, alpi_scratch_create(s->context, s->texels.count, false, &scratch));
    alp_result result = alpi_occlusion_rounds(&task, report);
    alpi_scratch_destroy(&scratch);
    alpi_occlusion_release(&setup);
    return result;
}

static uint32_t texel_at(const painting *s, uint32_t x, uint32_t y)
{
    const uint32_t t = alpi_lattice_texel(&s->lattice, 0, x, y);
    assert_true(t != ALPI_NONE);
    return t;
}

// --- the flood -----------------------------------------------------------------------------------

TEST(thin_shadows_are_followed)
{
    // A shadow one texel wide runs between the rows of the lattice: nothing that is interpolated
    // has a dark texel beside it. It begins under a texel of the lattice, and the texels whose
    // stencils hold that are traced; from there only steps to what is interpolated lead on, a texel
    // in each of four rounds.
    enum { X = 24, Y = 24, LENGTH = 8 };
    painting s;
    set_up(&s);
    const alpi_occlusion_task options = {.accuracy = ALP_ADAPTIVE_AUTO, .deadline = HUGE_VAL};
    alpi_occlusion_report bare, report;
    ASSERT_OK(s.context, run(&s, &options, &bare));
    s.paints[texel_at(&s, X, Y)] = DARK;
    for (uint32_t i = 0; i < LENGTH; i++) {
        s.paints[texel_at(&s, X + i, Y + 1)] = DARK;
    }
    ASSERT_OK(s.context, run(&s, &options, &report));
    for (uint32_t t = 0; t < s.texels.count; t++) {
        ASSERT_NEAR(s.lattice.values[t], s.paints[t] == DARK ? 0.0 : 1.0, 1e-6);
    }
    // And no farther: what is traced besides is within the reach of a stencil of the shadow.
    print_message("traced: %llu without the shadow, %llu with it\n",
                  (unsigned long long)bare.traced, (unsigned long long)report.traced);
    assert_true(report.traced < bare.traced + (LENGTH + 12) * (2 + 12));
    assert_true(bare.traced < s.texels.count / 4);
    assert_int_equal(report.traced + report.interpolated, s.texels.count);
    tear_down(&s);
}

// --- rounds --------------------------------------------------------------------------------------

TEST(the_worst_hundredth_asks_for_more)
{
    // A block of 64 texels in some 3,600 is noisy, all others are exact: a mean hides its error.
    // The 99th percentile is of the block, and at most √(3600 / 64) = 7.5 root mean squares.
    painting s;
    set_up(&s);
    for (uint32_t i = 0; i < 64; i++) {
        s.paints[texel_at(&s, 24 + i % 8, 24 + i / 8)] = MIXED;
    }
    s.options.samples = 1 << 14;
    alpi_occlusion_report first, report;
    alpi_occlusion_task options = {
        .accuracy = ALP_ADAPTIVE_OFF, .error = 1.0f, .deadline = HUGE_VAL};
    ASSERT_OK(s.context, run(&s, &options, &first));
    print_message("%u samples: rms %.5f, p99 %.5f\n", first.samples, first.relative, first.p99);
    assert_true(first.p99 > 4.0 * first.relative);
    // Between the two: the mean would be content with the first round.
    options.error = (float)sqrt(first.relative * first.p99 / 4.0);
    assert_true(first.relative < (double)options.error);
    ASSERT_OK(s.context, run(&s, &options, &report));
    print_message("%u samples: rms %.5f, p99 %.5f, wanted %.5f\n", report.samples, report.relative,
                  report.p99, (double)options.error);
    assert_true(report.samples > first.samples && report.samples < s.options.samples);
    assert_true(report.p99 <= 4.0 * (double)options.error);
    tear_down(&s);
}

// --- cut off -------------------------------------------------------------------------------------

static bool stop_after(void *user, const alp_progress *progress)
{
    (void)progress;
    int *left = user;
    return --*left > 0;
}

static void assert_nothing_left_that_could_be_filled(const painting *s)
{
    for (uint32_t t = 0; t < s->texels.count; t++) {
        alpi_stencil stencil;
        const float value = s->lattice.values[t];
        assert_true(value >= 0.0f && value <= 1.0f);
        assert_true(s->lattice.states[t] != ALPI_TEXEL_OPEN ||
                    !alpi_lattice_stencil(&s->lattice, t, &stencil));
    }
}

TEST(what_is_cut_off_is_filled_whatever_its_contrast)
{
    // Spots of dark, open and mixed: no texel is smooth enough to be interpolated by choice.
    painting s;
    set_up(&s);
    for (uint32_t t = 0; t < s.texels.count; t++) {
        s.paints[t] = (uint8_t)(alpi_hash32(t) % 3);
    }
    uint32_t cut_off = 0, filled = 0;
    alpi_occlusion_report report = {.cut_off = true};
    for (int calls = 1; report.cut_off; calls++) {
        int left = calls;
        const alpi_occlusion_task options = {.accuracy = ALP_ADAPTIVE_AUTO,
                                             .deadline = HUGE_VAL,
                                             .keep_partial = true,
                                             .progress = stop_after,
                                             .progress_user = &left};
        const alp_result result = run(&s, &options, &report);
        if (result == ALP_OK && report.cut_off) {
            assert_nothing_left_that_could_be_filled(&s);
            assert_int_equal(report.traced + report.interpolated + report.unknown, s.texels.count);
            cut_off++;
            filled += report.interpolated > s.texels.count / 2 && report.unknown < SIZE * 8;
        } else {
            assert_true(result == ALP_OK || (report.cut_off && report.traced == 0));
        }
    }
    print_message("cut off at %u points, mostly filled at %u\n", cut_off, filled);
    assert_true(cut_off >= 3 && filled >= 1);
    tear_down(&s);
}
