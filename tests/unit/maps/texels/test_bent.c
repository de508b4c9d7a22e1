// SPDX-License-Identifier: MIT
// Bent normals of a map: interpolated ones are as good as traced ones.
#include "bake/occlusion/occlusion_rounds.h"
#include "base/context.h"
#include "base/tasks.h"
#include "maps/texels/bent.h"
#include "maps/texels/validity.h"
#include "test_scenes.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 96, SAMPLES = 256, TRUTH_SAMPLES = 1 << 12 };

typedef struct map_setup {
    alp_context *context;
    alp_scene *scene;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_tracer *tracer;
    alpi_receivers receivers;
    alpi_lattice lattice;
    float (*bent)[3], *errors;
} map_setup;

/// Into *s: the receivers point into it.
static void set_up(map_setup *s, uint32_t workers, const char *scene)
{
    *s = (map_setup){.context = test_context(workers)};
    ASSERT_OK(s->context, alp_scene_load(s->context, scene, &s->scene));
    alp_atlas_options atlas = alp_atlas_options_default();
    atlas.size = SIZE;
    ASSERT_OK(s->context, alp_atlas_create(s->scene, &atlas, &s->atlas));
    ASSERT_OK(s->context, alpi_texels_create(s->atlas, &s->texels));
    ASSERT_OK(s->context, alpi_tracer_for_scene(s->scene, NULL, NULL, &s->tracer, NULL));
    ASSERT_OK(s->context, alpi_lattice_create(s->atlas, &s->texels, &s->lattice));
    s->bent = calloc(s->texels.count, sizeof *s->bent);
    s->errors = calloc(s->texels.count, sizeof *s->errors);
    assert_true(s->bent != NULL && s->errors != NULL);
    s->receivers = alpi_texels_receivers(&s->texels);
}

static void tear_down(map_setup *s)
{
    free(s->bent);
    free(s->errors);
    alpi_lattice_destroy(&s->lattice);
    alpi_texels_destroy(s->context, &s->texels);
    alp_atlas_destroy(s->atlas);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

static void run(map_setup *s, uint32_t samples, uint64_t seed, float accuracy, float error)
{
    alp_occlusion_options options = alp_occlusion_options_default();
    options.samples = samples;
    options.seed = seed;
    alpi_occlusion_setup setup;
    ASSERT_OK(s->context, alpi_occlusion_prepare(s->scene, s->tracer, &options, &setup));
    setup.bent = true;
    alpi_validity validity;
    ASSERT_OK(s->context, alpi_validity_create(&setup, &s->receivers, &s->texels, &s->lattice,
                                               s->lattice.order, s->texels.count, NULL, &validity));
    alpi_scratch scratch;
    ASSERT_OK(s->context, alpi_scratch_create(s->context, s->texels.count, true, &scratch));
    const alpi_occlusion_task task = {.setup = &setup,
                                      .receivers = &s->receivers,
                                      .order = s->lattice.order,
                                      .count = s->texels.count,
                                      .proximity = validity.proximity,
                                      .lattice = &s->lattice,
                                      .errors = s->errors,
                                      .bent = s->bent,
                                      .scratch = &scratch,
                                      .accuracy = accuracy,
                                      .error = error,
                                      .deadline = HUGE_VAL};
    alpi_occlusion_report report;
    ASSERT_OK(s->context, alpi_occlusion_rounds(&task, &report));
    alpi_scratch_destroy(&scratch);
    alpi_validity_destroy(&validity);
    alpi_occlusion_release(&setup);
}

static double squared_distance(const float a[3], const float b[3])
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        sum += pow((double)a[k] - (double)b[k], 2);
    }
    return sum;
}

TEST_SLOW(interpolated_ones_are_as_good_as_traced_ones)
{
    const char *const scenes[] = {"builtin:torus-plane", "builtin:cornell", "builtin:teapot-room"};
    for (int i = 0; i < 3; i++) {
        map_setup s, truth;
        set_up(&s, 2, scenes[i]);
        set_up(&truth, 2, scenes[i]);
        run(&s, SAMPLES, 0, ALP_ADAPTIVE_AUTO, 0.0f);
        run(&truth, TRUTH_SAMPLES, 99, ALP_ADAPTIVE_OFF, 0.0f);
        double square[3] = {0}, weights[3] = {0};
        for (uint32_t t = 0; t < s.texels.count; t++) {
            const uint8_t state_of = s.lattice.states[t];
            ASSERT_NEAR(vec3_length(vec3_load(s.bent[t])), 1.0, 1e-6);
            // where little is open a direction rests on few rays, and little light depends on it
            const double weight = (double)truth.lattice.values[t];
            square[state_of] += weight * squared_distance(s.bent[t], truth.bent[t]);
            weights[state_of] += weight;
        }
        assert_true(weights[ALPI_TEXEL_OPEN] == 0.0 && weights[ALPI_TEXEL_INTERPOLATED] > 100.0);
        double rms[3];
        for (int k = ALPI_TEXEL_TRACED; k <= ALPI_TEXEL_INTERPOLATED; k++) {
            rms[k] = sqrt(square[k] / weights[k]);
        }
        print_message(
            "accuracy: bent normals of %s: rms angle %.4f rad traced, %.4f interpolated\n",
            scenes[i], rms[ALPI_TEXEL_TRACED], rms[ALPI_TEXEL_INTERPOLATED]);
        assert_true(rms[ALPI_TEXEL_TRACED] < 0.03);
        assert_true(rms[ALPI_TEXEL_INTERPOLATED] < rms[ALPI_TEXEL_TRACED]);
        tear_down(&s);
        tear_down(&truth);
    }
}

TEST(any_number_of_workers_gives_the_same_bits)
{
    static const uint32_t workers[] = {1, 2, 7, 32};
    float(*first)[3] = NULL;
    for (int w = 0; w < 4; w++) {
        map_setup s;
        set_up(&s, workers[w], "builtin:teapot-room");
        run(&s, 1024, 0, ALP_ADAPTIVE_AUTO, 0.02f); // some rounds
        const size_t size = s.texels.count * sizeof *s.bent;
        if (first == NULL) {
            first = malloc(size);
            assert_non_null(first);
            memcpy(first, s.bent, size);
        }
        assert_memory_equal(first, s.bent, size);
        tear_down(&s);
    }
    free(first);
}

TEST(cubic_weights_that_turn_a_direction_over_are_dropped)
{
    // Sums as a test chooses them: of one row of texels only the outer two of a stencil, whose
    // weights are negative, have seen anything. The middle gets its normal and nothing below it.
    map_setup s;
    set_up(&s, 1, "builtin:furnace");
    run(&s, 4, 0, ALP_ADAPTIVE_OFF, 0.0f);
    alpi_occlusion_sums sums;
    ASSERT_OK(s.context, alpi_occlusion_sums_create(s.context, s.texels.count, true, &sums));
    int tried = 0;
    for (uint32_t t = 0; t < s.texels.count; t++) {
        alpi_stencil stencil;
        if (alpi_lattice_level(s.texels.pixels[t]) != 1 ||
            !alpi_lattice_stencil(&s.lattice, t, &stencil) || stencil.count != 4) {
            continue;
        }
        memset(sums.vectors, 0, s.texels.count * sizeof *sums.vectors);
        for (uint32_t i = 0; i < 4; i++) {
            const uint32_t n = stencil.texels[i];
            sums.done[n] = 8;
            if (stencil.weights[i] < 0.0f) {
                vec3_store(sums.vectors[n], vec3_load(s.texels.normals[t]));
            }
        }
        s.lattice.states[t] = ALPI_TEXEL_INTERPOLATED;
        ASSERT_OK(s.context, alpi_bent_normals(&s.lattice, &sums, s.lattice.order, s.texels.count,
                                               NULL, s.bent));
        assert_true(squared_distance(s.bent[t], s.texels.normals[t]) < 1e-10);
        s.lattice.states[t] = ALPI_TEXEL_TRACED;
        tried++;
        if (tried == 10) {
            break;
        }
    }
    assert_true(tried > 0);
    alpi_occlusion_sums_destroy(s.context, &sums);
    tear_down(&s);
}
