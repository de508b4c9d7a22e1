// SPDX-License-Identifier: MIT
// Which texels are traced, when it stops, and whether what it says of its error is true.
#include "bake/occlusion/occlusion_rounds.h"
#include "base/context.h"
#include "base/tasks.h"
#include "maps/texels/validity.h"
#include "test_scenes.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 64, TRUTH_SAMPLES = 1 << 13 };

typedef struct map_setup {
    alp_context *context;
    alp_scene *scene;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_tracer *tracer;
    alpi_receivers receivers;
    alp_occlusion_options options;
    float *errors, *truth;
} map_setup;

/// Into *s: the receivers point into it.
static void set_up(map_setup *setup, uint32_t workers, const char *scene)
{
    map_setup s = {.context = test_context(workers)};
    ASSERT_OK(s.context, alp_scene_load(s.context, scene, &s.scene));
    alp_atlas_options atlas = alp_atlas_options_default();
    atlas.size = SIZE;
    ASSERT_OK(s.context, alp_atlas_create(s.scene, &atlas, &s.atlas));
    ASSERT_OK(s.context, alpi_texels_create(s.atlas, &s.texels));
    ASSERT_OK(s.context, alpi_tracer_for_scene(s.scene, NULL, NULL, &s.tracer, NULL));
    s.options = alp_occlusion_options_default();
    s.options.samples = 256;
    s.errors = calloc(s.texels.count, sizeof *s.errors);
    s.truth = calloc(s.texels.count, sizeof *s.truth);
    assert_true(s.errors != NULL && s.truth != NULL);
    *setup = s;
    setup->receivers = alpi_texels_receivers(&setup->texels);
}

static void tear_down(map_setup *s)
{
    free(s->errors);
    free(s->truth);
    alpi_texels_destroy(s->context, &s->texels);
    alp_atlas_destroy(s->atlas);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

/// @param options accuracy and what ends the rounds
static alp_result run(map_setup *s, const alpi_occlusion_task *options, alpi_lattice *lattice,
                      alpi_occlusion_report *report)
{
    alpi_occlusion_setup setup;
    ASSERT_OK(s->context, alpi_lattice_create(s->atlas, &s->texels, lattice));
    ASSERT_OK(s->context, alpi_occlusion_prepare(s->scene, s->tracer, &s->options, &setup));
    alpi_validity validity;
    ASSERT_OK(s->context, alpi_validity_create(&setup, &s->receivers, &s->texels, lattice,
                                               lattice->order, s->texels.count, NULL, &validity));
    alpi_scratch scratch;
    alpi_occlusion_task task = *options;
    task.setup = &setup;
    task.receivers = &s->receivers;
    task.order = lattice->order;
    task.count = s->texels.count;
    task.proximity = validity.proximity;
    task.lattice = lattice;
    task.errors = s->errors;
    task.scratch = &scratch;
    ASSERT_OK(s->context, alpi_scratch_create(s->context, s->texels.count, false, &scratch));
    alp_result result = alpi_occlusion_rounds(&task, report);
    alpi_scratch_destroy(&scratch);
    alpi_validity_destroy(&validity);
    alpi_occlusion_release(&setup);
    return result;
}

static void find_truth(map_setup *s)
{
    alp_occlusion_options options = s->options;
    alpi_occlusion_setup setup;
    alpi_lattice lattice; // a first run finds which strata are valid, with as many rays as you like
    alpi_occlusion_report report;
    const alpi_occlusion_task once = {.accuracy = ALP_ADAPTIVE_OFF, .deadline = HUGE_VAL};
    s->options.samples = 4;
    ASSERT_OK(s->context, run(s, &once, &lattice, &report));
    alpi_lattice_destroy(&lattice);
    s->options.samples = options.samples;
    options.samples = TRUTH_SAMPLES;
    options.seed = 99;
    ASSERT_OK(s->context, alpi_occlusion_prepare(s->scene, s->tracer, &options, &setup));
    ASSERT_OK(s->context,
              alpi_occlusion_gather(&setup, &s->receivers, NULL, s->texels.count, s->truth));
    alpi_occlusion_release(&setup);
}

static double true_rmse(const map_setup *s, const alpi_lattice *l)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < s->texels.count; i++) {
        sum += pow((double)l->values[i] - (double)s->truth[i], 2);
    }
    return sqrt(sum / s->texels.count);
}

static double mean_of(const map_setup *s)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < s->texels.count; i++) {
        sum += (double)s->truth[i] / s->texels.count;
    }
    return sum;
}

/// Bakes with some seeds: one small map has too few held-out texels to be judged alone.
/// @param report of the last; stated and rmse are root mean squares over the seeds
static void judge(map_setup *s, float accuracy, alpi_occlusion_report *report, double *stated,
                  double *rmse)
{
    enum { SEEDS = 6 };
    const alpi_occlusion_task options = {.accuracy = accuracy, .deadline = HUGE_VAL};
    double stated_squares = 0.0, squares = 0.0;
    for (s->options.seed = 0; s->options.seed < SEEDS; s->options.seed++) {
        alpi_lattice lattice;
        ASSERT_OK(s->context, run(s, &options, &lattice, report));
        stated_squares += pow(report->relative * mean_of(s), 2) / SEEDS;
        squares += pow(true_rmse(s, &lattice), 2) / SEEDS;
        alpi_lattice_destroy(&lattice);
    }
    *stated = sqrt(stated_squares);
    *rmse = sqrt(squares);
}

TEST_SLOW(interpolation_saves_rays_and_no_truth)
{
    map_setup s;
    set_up(&s, 2, "builtin:torus-plane");
    find_truth(&s);
    double rmse[2], stated[2];
    alpi_occlusion_report reports[2];
    for (int adaptive = 0; adaptive < 2; adaptive++) {
        judge(&s, adaptive ? ALP_ADAPTIVE_AUTO : ALP_ADAPTIVE_OFF, &reports[adaptive],
              &stated[adaptive], &rmse[adaptive]);
        print_message(
            "accuracy: %s: %llu traced, %llu interpolated, rmse %.5f, stated %.5f\n",
            adaptive ? "adaptive" : "all traced", (unsigned long long)reports[adaptive].traced,
            (unsigned long long)reports[adaptive].interpolated, rmse[adaptive], stated[adaptive]);
        assert_true(fabs(stated[adaptive] / rmse[adaptive] - 1.0) < 0.15);
    }
    assert_int_equal(reports[0].traced, s.texels.count);
    assert_true(reports[1].traced < s.texels.count * 3 / 5);
    assert_int_equal(reports[1].traced + reports[1].interpolated, s.texels.count);
    assert_true(rmse[1] < 1.1 * rmse[0]);
    tear_down(&s);
}

/// Whether the values of a stencil are those it was taken from: what overshoots was cut off after.
static bool is_within(const alpi_lattice *l, const alpi_stencil *s)
{
    for (uint32_t i = 0; i < s->count; i++) {
        const float value = l->values[s->texels[i]];
        if (!(value > 0.0f && value < 1.0f)) {
            return false;
        }
    }
    return true;
}

TEST(interpolated_texels_hold_the_value_of_their_stencil)
{
    map_setup s;
    set_up(&s, 2, "builtin:cornell"); // where the flood traces among what is interpolated
    s.options.samples = 1024;
    const alpi_occlusion_task options = {
        .accuracy = ALP_ADAPTIVE_AUTO, .error = 0.001f, .deadline = HUGE_VAL};
    alpi_lattice lattice;
    alpi_occlusion_report report;
    ASSERT_OK(s.context, run(&s, &options, &lattice, &report));
    uint32_t compared = 0;
    for (uint32_t t = 0; t < s.texels.count; t++) {
        alpi_stencil stencil;
        if (lattice.states[t] == ALPI_TEXEL_INTERPOLATED) {
            assert_true(alpi_lattice_stencil(&lattice, t, &stencil));
            if (is_within(&lattice, &stencil)) {
                const float value = alpi_lattice_interpolate(&lattice, &stencil);
                ASSERT_NEAR(lattice.values[t], fminf(fmaxf(value, 0.0f), 1.0f), 0.0);
                compared++;
            }
        }
    }
    assert_true(compared > s.texels.count / 20);
    alpi_lattice_destroy(&lattice);
    tear_down(&s);
}

TEST_SLOW(any_number_of_workers_gives_the_same_map)
{
    static const uint32_t workers[] = {1, 2, 7, 32};
    float *first = NULL;
    uint32_t count = 0;
    for (int w = 0; w < 4; w++) {
        map_setup s;
        set_up(&s, workers[w], "builtin:teapot-room");
        s.options.samples = 1024;
        const alpi_occlusion_task options = {
            .accuracy = ALP_ADAPTIVE_AUTO, .error = 0.02f, .deadline = HUGE_VAL};
        alpi_lattice lattice;
        alpi_occlusion_report report;
        ASSERT_OK(s.context, run(&s, &options, &lattice, &report));
        if (w == 0) {
            count = s.texels.count;
            first = malloc(2 * count * sizeof *first);
            assert_non_null(first);
            memcpy(first, lattice.values, count * sizeof *first);
            memcpy(first + count, s.errors, count * sizeof *first);
        }
        assert_memory_equal(first, lattice.values, count * sizeof *first);
        assert_memory_equal(first + count, s.errors, count * sizeof *first);
        alpi_lattice_destroy(&lattice);
        tear_down(&s);
    }
    free(first);
}

TEST_SLOW(rounds_stop_at_the_wanted_error)
{
    map_setup s;
    set_up(&s, 2, "builtin:cornell");
    s.options.samples = 1 << 14;
    find_truth(&s);
    uint64_t rays = 0;
    for (int i = 0; i < 2; i++) {
        const double wanted = i == 0 ? 0.02 : 0.005;
        const alpi_occlusion_task options = {
            .accuracy = ALP_ADAPTIVE_AUTO, .error = (float)wanted, .deadline = HUGE_VAL};
        alpi_lattice lattice;
        alpi_occlusion_report report;
        ASSERT_OK(s.context, run(&s, &options, &lattice, &report));
        assert_true(report.relative <= wanted && report.p99 <= 4.0 * wanted);
        assert_true(report.samples < s.options.samples && report.rays > rays);
        assert_true(true_rmse(&s, &lattice) < 1.25 * wanted * mean_of(&s));
        rays = report.rays;
        alpi_lattice_destroy(&lattice);
    }
    // Too few rays allowed: it ends there, with its error stated.
    s.options.samples = 64;
    const alpi_occlusion_task options = {
        .accuracy = ALP_ADAPTIVE_AUTO, .error = 0.001f, .deadline = HUGE_VAL};
    alpi_lattice lattice;
    alpi_occlusion_report report;
    ASSERT_OK(s.context, run(&s, &options, &lattice, &report));
    assert_true(report.relative > 0.001 && report.samples == 64);
    alpi_lattice_destroy(&lattice);
    tear_down(&s);
}

/// Stated error of all samples of each texel, in one go or in rounds. @param values out: [texels]
static double trace_all(map_setup *s, bool rounds, float *values)
{
    const alpi_occlusion_task options = {
        .accuracy = ALP_ADAPTIVE_OFF, .error = rounds ? 1e-4f : 0.0f, .deadline = HUGE_VAL};
    alpi_lattice lattice;
    alpi_occlusion_report report;
    ASSERT_OK(s->context, run(s, &options, &lattice, &report));
    assert_int_equal(report.samples, s->options.samples);
    for (uint32_t t = 0; t < s->texels.count; t++) {
        const float open = lattice.values[t] * (float)s->options.samples;
        ASSERT_NEAR(open, roundf(open), 1e-3); // of all samples, whatever they met
        values[t] = lattice.values[t];
    }
    alpi_lattice_destroy(&lattice);
    return report.relative;
}

TEST(the_last_round_uses_all_samples)
{
    map_setup s;
    set_up(&s, 2, "builtin:torus-plane");
    float *once = calloc(s.texels.count, sizeof *once);
    float *rounds = calloc(s.texels.count, sizeof *rounds);
    assert_true(once != NULL && rounds != NULL);
    // Neither is a multiple of the first round's. Of 192 all leave from the same points in rounds,
    // so that texels get the same bits; of 100 some leave from others.
    static const uint32_t samples[2] = {192, 100};
    for (int i = 0; i < 2; i++) {
        s.options.samples = samples[i];
        const double stated = trace_all(&s, false, once);
        const double stated_rounds = trace_all(&s, true, rounds);
        double sum = 0.0;
        for (uint32_t t = 0; t < s.texels.count; t++) {
            sum += pow((double)once[t] - (double)rounds[t], 2);
        }
        assert_true(i == 0 ? sum == 0.0 : sqrt(sum / s.texels.count) < stated);
        // Of the same values and held-out texels the factors leave the mean of the squares as it
        // is, up to what levels out where quarters happen to be equal.
        ASSERT_NEAR(stated_rounds / stated, 1.0, i == 0 ? 0.05 : 0.1);
    }
    free(once);
    free(rounds);
    tear_down(&s);
}

static bool stop_after(void *user, const alp_progress *progress)
{
    (void)progress;
    int *left = user;
    return --*left > 0;
}

TEST(what_is_cut_off_keeps_what_it_has)
{
    map_setup s;
    set_up(&s, 2, "builtin:cornell");
    s.options.samples = 1 << 18;
    int left = 3;
    alpi_occlusion_task options = {.accuracy = ALP_ADAPTIVE_OFF,
                                   .deadline = HUGE_VAL,
                                   .keep_partial = true,
                                   .progress = stop_after,
                                   .progress_user = &left};
    alpi_lattice lattice;
    alpi_occlusion_report report;
    ASSERT_OK(s.context, run(&s, &options, &lattice, &report));
    assert_true(report.cut_off);
    assert_int_equal(report.traced + report.interpolated + report.unknown, s.texels.count);
    alpi_lattice_destroy(&lattice);
    left = 3;
    options.keep_partial = false;
    assert_int_equal(run(&s, &options, &lattice, &report), ALP_ERROR_CANCELLED);
    alpi_lattice_destroy(&lattice);
    // A deadline: rounds as far as they come, each texel with a value of its own after the first.
    options = (alpi_occlusion_task){.accuracy = ALP_ADAPTIVE_OFF, .deadline = alpi_seconds() + 0.4};
    ASSERT_OK(s.context, run(&s, &options, &lattice, &report));
    assert_true(report.cut_off);
    assert_true(report.samples < s.options.samples);
    alpi_lattice_destroy(&lattice);
    tear_down(&s);
}
