// SPDX-License-Identifier: MIT
// Direct light of a few even polygons: closed forms without noise where all or nothing is visible,
// from any point and side; penumbrae without bias; the same bits however it is computed.
#include "test_direct_stage.h"

#include "base/random.h"
#include "scene/lights/polygon_light.h"

#include <math.h>
#include <stdio.h>

static const vec3 UP = {0, 1, 0}, DARK = {0, 0, 0}, GREY = {0.5f, 0.5f, 0.5f};
static const vec3 QUAD[4] = {{-1, 2, -0.5f}, {1, 2, -0.5f}, {1, 2, 0.5f}, {-1, 2, 0.5f}};
TEST_CONTEXT(1);

/// The quad, of radiance 3, and a dark one besides where `screen` is one.
static test_stage open_quad(alp_context *made_in, bool two_sided, const vec3 *screen)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, made_in, "quad");
    const uint32_t light = alpi_builder_material(&b, "light", GREY, (vec3){3, 3, 3});
    b.scene->materials[light].double_sided = two_sided;
    alpi_builder_surface(&b, "light", light);
    alpi_builder_quad(&b, QUAD);
    if (screen != NULL) {
        alpi_builder_surface(&b, "screen", alpi_builder_material(&b, "screen", GREY, DARK));
        alpi_builder_quad(&b, screen);
    }
    ASSERT_OK(made_in, alpi_builder_finish(&b, &scene));
    return test_stage_open(made_in, scene, NULL, 0, NULL);
}

/// π L F of the quad without obstacles.
static double exact(const test_patch *p, bool two_sided)
{
    const double f = alpi_polygon_form_factor(p->corner, p->normal, QUAD, 4);
    return 3.0 * ALPI_PI * (two_sided ? fabs(f) : fmax(f, 0.0));
}

enum { POINTS = 509 }; // no multiple of 8
/// Points all around the quad, near ones too, that look anywhere.
static void scatter(test_patch points[POINTS])
{
    for (uint32_t i = 0; i < POINTS; i++) {
        const vec2 u = alpi_sample_2d(1, i), v = alpi_sample_2d(2, i), w = alpi_sample_2d(3, i);
        const float y = 2.0f * w.x - 1.0f, r = sqrtf(1.0f - y * y), size = i % 2 == 0 ? 6.0f : 2.0f;
        const double phi = 2.0 * ALPI_PI * (double)w.y;
        points[i] =
            test_point((vec3){size * (u.x - 0.5f), 2.0f + size * (v.x - 0.5f), size * (u.y - 0.5f)},
                       vec3_normalize_or((vec3){r * (float)cos(phi), y, r * (float)sin(phi)}, UP));
    }
}

static void gather_by(uint32_t samples, const test_stage *s, const test_patch *points,
                      const uint32_t *list, uint32_t list_count, alpi_reference_value *values)
{
    const test_patches patches = {.count = POINTS, .patches = points, .offset = 1e-6f};
    const alpi_receivers receivers = test_patches_receivers(&patches);
    const alpi_direct_options o = test_stage_options(s, samples);
    alpi_direct *direct = NULL;
    alpi_direct_output output = {.values = values};
    ASSERT_OK(s->context, alpi_direct_create(&o, &direct));
    ASSERT_OK(s->context,
              alpi_direct_irradiance(direct, &receivers, list, list_count, NULL, &output));
    alpi_direct_destroy(direct);
}

static void gather(const test_stage *s, const test_patch *points, const uint32_t *list,
                   uint32_t list_count, alpi_reference_value *values)
{
    gather_by(256, s, points, list, list_count, values);
}

/// From any point and side, above the horizon and below: the closed form, and no noise, however few
/// the samples and however little of the quad is above the horizon.
TEST(all_of_it)
{
    static test_patch points[POINTS];
    static alpi_reference_value values[POINTS];
    scatter(points);
    for (int way = 0; way < 4; way++) {
        const bool two_sided = way % 2 != 0;
        test_stage s = open_quad(context, two_sided, NULL);
        uint32_t lit = 0;
        gather_by(way < 2 ? 8 : 256, &s, points, NULL, 0, values);
        for (uint32_t i = 0; i < POINTS; i++) {
            const double e = exact(&points[i], two_sided);
            // Angles to 1e-9, and floats.
            ASSERT_NEAR(values[i].mean[0], e, 1e-6 * e + 1e-9);
            assert_true(sqrt((double)values[i].variance[0]) <= 1e-7 * e);
            lit += e > 0.0;
        }
        assert_true(lit > POINTS / 5);
        test_stage_close(&s);
    }
}

/// Behind a screen all is dark, without noise.
TEST(nothing_of_it)
{
    const vec3 screen[4] = {{-9, 1, -9}, {9, 1, -9}, {9, 1, 9}, {-9, 1, 9}};
    test_stage s = open_quad(context, false, screen);
    const test_patch p = {{-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, UP};
    const alpi_reference_value v = test_stage_direct(&s, &p, 64, 1, NULL);
    assert_true(v.mean[0] == 0.0f && v.variance[0] == 0.0f);
    test_stage_close(&s);
}

/// What lies on the quad, on either side, does not see it.
TEST(on_it)
{
    test_stage s = open_quad(context, true, NULL);
    for (int k = 0; k < 2; k++) {
        const test_patch p = {
            {-0.5f, 2, -0.3f}, {1, 0, 0}, {0, 0, 0.5f}, {0, k == 0 ? 1.0f : -1.0f, 0}};
        assert_true(test_stage_direct(&s, &p, 64, 1, NULL).mean[0] == 0.0f);
    }
    test_stage_close(&s);
}

/// A screen halfway hides all beyond x = −.7 + 2 · .3 = −.1 of the quad from x = −.7. Over seeds
/// the mean of few samples errs by less than 1 %, most of it from the ratio of means, and the
/// stated error is true.
TEST_SLOW(a_penumbra)
{
    enum { SEEDS = 1024 };
    const vec3 screen[4] = {{-0.4f, 1, -5}, {5, 1, -5}, {5, 1, 5}, {-0.4f, 1, 5}};
    const vec3 seen[4] = {{-1, 2, -0.5f}, {-0.1f, 2, -0.5f}, {-0.1f, 2, 0.5f}, {-1, 2, 0.5f}};
    test_stage s = open_quad(context, false, screen);
    const test_patch p = test_point((vec3){-0.7f, 0, 0}, UP);
    const double e = 3.0 * ALPI_PI * alpi_polygon_form_factor(p.corner, UP, seen, 4);
    ASSERT_LIGHT(test_stage_direct(&s, &p, 1u << 15, 5, NULL), e);
    for (uint32_t samples = 16; samples <= 64; samples *= 2) {
        double mean = 0.0, squares = 0.0, stated = 0.0;
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            const alpi_reference_value v = test_stage_direct(&s, &p, samples, seed, NULL);
            const double apart = (double)v.mean[0] - e;
            mean += apart / SEEDS;
            squares += apart * apart / SEEDS;
            stated += (double)v.variance[0] / SEEDS;
        }
        printf(
            "accuracy: penumbra of a quad, %u samples: bias %+.2f %%, error %.2f %%, stated over "
            "true error %.2f\n",
            samples, 100.0 * mean / e, 100.0 * sqrt(squares) / e, sqrt(stated / squares));
        assert_true(fabs(mean) < 4.0 * sqrt(squares / SEEDS) + 0.16 / samples * e);
        ASSERT_NEAR(sqrt(stated / squares), 1.0, 0.12); // 4 standard errors of 1,024 squares
    }
    test_stage_close(&s);
}

/// Mean square error at the first of `count` receivers in one place, and its mean error.
static double error_beside(const test_stage *s, uint32_t count, double e, double *mean)
{
    enum { SEEDS = 1024 };
    test_patch alike[ALPI_PACKET];
    alpi_reference_value values[ALPI_PACKET];
    double squares = 0.0;
    *mean = 0.0;
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        alike[i] = test_point((vec3){0, 0, 0}, UP);
    }
    const test_patches patches = {.count = count, .patches = alike, .offset = 1e-6f};
    const alpi_receivers receivers = test_patches_receivers(&patches);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        alpi_direct_options o = test_stage_options(s, 64);
        alpi_direct *direct = NULL;
        alpi_direct_output output = {.values = values};
        o.seed = seed;
        ASSERT_OK(s->context, alpi_direct_create(&o, &direct));
        ASSERT_OK(s->context, alpi_direct_irradiance(direct, &receivers, NULL, 0, NULL, &output));
        alpi_direct_destroy(direct);
        const double apart = (double)values[0].mean[0] - e;
        *mean += apart / SEEDS;
        squares += apart * apart / SEEDS;
    }
    return squares;
}

/// A screen hides a hundredth of the quad, which the first samples of one receiver may not find:
/// those beside it do, and nobody is biased.
TEST(neighbours_find)
{
    const vec3 screen[4] = {{-0.005f, 1, -5}, {0.005f, 1, -5}, {0.005f, 1, 5}, {-0.005f, 1, 5}};
    const vec3 hidden[4] = {
        {-0.01f, 2, -0.5f}, {0.01f, 2, -0.5f}, {0.01f, 2, 0.5f}, {-0.01f, 2, 0.5f}};
    test_stage s = open_quad(context, false, screen);
    const test_patch p = test_point((vec3){0, 0, 0}, UP);
    const double e =
        exact(&p, false) - 3.0 * ALPI_PI * alpi_polygon_form_factor(p.corner, UP, hidden, 4);
    double mean[2];
    const double alone = error_beside(&s, 1, e, &mean[0]);
    const double beside = error_beside(&s, ALPI_PACKET, e, &mean[1]);
    printf(
        "accuracy: a hundredth of a quad hidden, 64 samples: error %.2f %% alone, %.2f %% beside "
        "seven\n",
        100.0 * sqrt(alone) / e, 100.0 * sqrt(beside) / e);
    assert_true(fabs(mean[0]) < 4.0 * sqrt(alone / 1024.0));
    assert_true(fabs(mean[1]) < 4.0 * sqrt(beside / 1024.0));
    assert_true(beside < 0.7 * alone); // ± 4 % each
    test_stage_close(&s);
}

enum { BLOCKS = 8 * ALPI_PACKET };
/// What many receivers alike found by the fewest samples, over seeds: errors over what is exact.
typedef struct seeds_found {
    double mean, squares, stated, rays; // rays of a receiver
} seeds_found;

static seeds_found gather_fewest(const test_stage *s, const test_patch alike[BLOCKS], double e,
                                 uint32_t seeds)
{
    static alpi_reference_value values[BLOCKS];
    const test_patches patches = {.count = BLOCKS, .patches = alike, .offset = 1e-6f};
    const alpi_receivers receivers = test_patches_receivers(&patches);
    const double each = 1.0 / ((double)BLOCKS * seeds);
    seeds_found f = {0.0, 0.0, 0.0, 0.0};
    for (uint32_t seed = 0; seed < seeds; seed++) {
        alpi_direct_options o = test_stage_options(s, ALPI_DIRECT_REPLICATES);
        alpi_direct *direct = NULL;
        alpi_direct_output output = {.values = values};
        o.seed = seed;
        ASSERT_OK(s->context, alpi_direct_create(&o, &direct));
        ASSERT_OK(s->context, alpi_direct_irradiance(direct, &receivers, NULL, 0, NULL, &output));
        alpi_direct_destroy(direct);
        f.rays += (double)output.rays * each;
        for (uint32_t i = 0; i < BLOCKS; i++) {
            const double apart = ((double)values[i].mean[0] - e) / e;
            f.mean += apart * each;
            f.squares += apart * apart * each;
            f.stated += (double)values[i].variance[0] / (e * e) * each;
        }
    }
    return f;
}

/// Blocks of receivers below a strip that hides a fiftieth of the quad, by the fewest samples there
/// are: half of those will do where neighbours and scouts find all clear, and who stops there is
/// neither biased nor too sure. In full light all do.
TEST(a_half_first)
{
    enum { SEEDS = 1024, SAMPLES = ALPI_DIRECT_REPLICATES };
    const vec3 screen[4] = {{-0.01f, 1, -5}, {0.01f, 1, -5}, {0.01f, 1, 5}, {-0.01f, 1, 5}};
    const vec3 hidden[4] = {
        {-0.02f, 2, -0.5f}, {0.02f, 2, -0.5f}, {0.02f, 2, 0.5f}, {-0.02f, 2, 0.5f}};
    static test_patch alike[BLOCKS];
    for (uint32_t i = 0; i < BLOCKS; i++) {
        alike[i] = test_point((vec3){0, 0, 0}, UP);
    }
    for (int screened = 0; screened < 2; screened++) {
        test_stage s = open_quad(context, false, screened ? screen : NULL);
        const double all = exact(&alike[0], false);
        const double e = all - screened * 3.0 * ALPI_PI *
                                   alpi_polygon_form_factor((vec3){0, 0, 0}, UP, hidden, 4);
        const seeds_found f = gather_fewest(&s, alike, e, SEEDS);
        if (!screened) {
            ASSERT_NEAR(f.rays, SAMPLES / 2 + 1, 1e-9); // a scout each
            assert_true(sqrt(f.squares) < 1e-6);
        } else {
            printf("accuracy: a fiftieth of a quad hidden, 8 samples: %.2f rays, bias %+.3f %%, "
                   "error %.2f %%, stated over true error %.3f\n",
                   f.rays, 100.0 * f.mean, 100.0 * sqrt(f.squares), sqrt(f.stated / f.squares));
            assert_true(f.rays > SAMPLES / 2 + 1.5 && f.rays < SAMPLES + 0.5); // some of either
            assert_true(fabs(f.mean) < 4.0 * sqrt(f.squares / (BLOCKS * SEEDS)));
            ASSERT_NEAR(sqrt(f.stated / f.squares), 1.0, 0.1);
        }
        test_stage_close(&s);
    }
}

/// The same of patches whose form factors differ from point to point, by a few hundredths: in full
/// light half of the points tells their mean. What is stated of it is that of points which know
/// nothing of each other, as there is no other half to say how much better a net of them is.
TEST(a_half_of_patches)
{
    enum { SEEDS = 512, SAMPLES = ALPI_DIRECT_REPLICATES };
    static test_patch alike[BLOCKS];
    for (uint32_t i = 0; i < BLOCKS; i++) {
        alike[i] = (test_patch){{0.6f, 0, 0.3f}, {0.15f, 0, 0}, {0, 0, 0.15f}, UP};
    }
    test_stage s = open_quad(context, false, NULL);
    const double e = (double)test_stage_direct(&s, alike, 1u << 15, 99, NULL).mean[0];
    const seeds_found f = gather_fewest(&s, alike, e, SEEDS);
    printf("accuracy: small patches in full light, 8 samples: %.2f rays, bias %+.4f %%, error "
           "%.3f %%, stated over true error %.3f\n",
           f.rays, 100.0 * f.mean, 100.0 * sqrt(f.squares), sqrt(f.stated / f.squares));
    assert_true(f.rays >= SAMPLES / 2 + 1 && f.rays < SAMPLES / 2 + 1.5);
    assert_true(fabs(f.mean) < 4.0 * sqrt(f.squares / (BLOCKS * SEEDS)));
    assert_true(sqrt(f.squares) < 0.004 && f.stated > f.squares && f.stated < 25.0 * f.squares);
    test_stage_close(&s);
}

/// The same bits alone or among others where nothing is hidden, though some are cut by the horizon
/// or near, and by the loops for other machines. (What is left of variances, rounding, is scaled by
/// what all of a call tell: see direct_sums.h.)
TEST(the_same_bits)
{
    static test_patch points[POINTS];
    static alpi_reference_value values[POINTS], others[POINTS];
    scatter(points);
    test_stage s = open_quad(context, true, NULL);
    gather(&s, points, NULL, 0, values);
    for (uint32_t i = 0; i < POINTS; i++) {
        gather(&s, points, &i, 1, others);
        assert_memory_equal(values[i].mean, others[i].mean, sizeof values[i].mean);
    }
    test_stage_close(&s);
    alp_context_options o = alp_context_options_default();
    alp_context *plain = NULL;
    o.max_isa = "sse4.2";
    o.worker_count = 1;
    assert_int_equal(alp_context_create(&o, &plain), ALP_OK);
    s = open_quad(plain, true, NULL); // no screen: the tracer may differ at its edges
    gather(&s, points, NULL, 0, others);
    test_stage_close(&s);
    alp_context_destroy(plain);
    s = open_quad(context, true, NULL);
    gather(&s, points, NULL, 0, values);
    assert_memory_equal(values, others, sizeof values);
    test_stage_close(&s);
}

/// A host that hands out ragged ranges, the last ones first. @param user how long they are
static void ragged_parallel_for(void *user, uint32_t count, uint32_t grain, alp_range_fn *body,
                                void *body_user)
{
    const uint32_t step = *(const uint32_t *)user;
    (void)grain;
    for (uint32_t end = count; end > 0;) {
        const uint32_t begin = end > step ? end - step : 0;
        body(body_user, begin, end, 0);
        end = begin;
    }
}

/// Receivers side by side share penumbrae, and who is beside whom is the list's to say, not the
/// host's: the same bits however it cuts loops.
TEST(a_host_changes_nothing)
{
    static test_patch points[POINTS];
    static alpi_reference_value values[POINTS], others[POINTS];
    static const vec3 screen[4] = {// which the first samples of few receivers find
                                   {-0.005f, 1, -5},
                                   {0.005f, 1, -5},
                                   {0.005f, 1, 5},
                                   {-0.005f, 1, 5}};
    for (uint32_t i = 0; i < POINTS; i++) {
        points[i] = test_point((vec3){0.006f * (float)i - 1.5f, 0, 0.1f}, UP);
    }
    test_stage s = open_quad(context, false, screen);
    gather_by(64, &s, points, NULL, 0, values);
    test_stage_close(&s);
    for (uint32_t step = 1; step <= 16; step += 5) {
        alp_context_options o = alp_context_options_default();
        alp_context *host = NULL;
        o.worker_count = 1;
        o.parallel_for = ragged_parallel_for;
        o.parallel_user = &step;
        assert_int_equal(alp_context_create(&o, &host), ALP_OK);
        s = open_quad(host, false, screen);
        gather_by(64, &s, points, NULL, 0, others);
        assert_memory_equal(values, others, sizeof values);
        test_stage_close(&s);
        alp_context_destroy(host);
    }
}

static bool note_total(void *user, const alp_progress *progress)
{
    *(uint64_t *)user = progress->total;
    return true;
}

static void check_rays(const test_stage *s, const test_patch *points, uint32_t count,
                       uint32_t samples)
{
    alpi_reference_value values[16];
    const test_patches patches = {.count = count, .patches = points, .offset = 1e-6f};
    const alpi_receivers receivers = test_patches_receivers(&patches);
    const alpi_direct_options o = test_stage_options(s, samples);
    uint64_t told = 0;
    const alpi_task_progress progress = {.callback = note_total, .user = &told};
    alpi_direct *direct = NULL;
    alpi_direct_output output = {.values = values};
    ASSERT_OK(context, alpi_direct_create(&o, &direct));
    ASSERT_OK(context, alpi_direct_irradiance(direct, &receivers, NULL, 0, &progress, &output));
    alpi_direct_destroy(direct);
    assert_false(told < output.rays);
}

/// Rays that are sent are no more than is told: however few receivers share the scouts, and where
/// others look for what the samples missed.
TEST(no_more_rays_than_are_told)
{
    enum { MOST = 16 };
    const vec3 screen[4] = {{-0.4f, 1, -5}, {5, 1, -5}, {5, 1, 5}, {-0.4f, 1, 5}};
    static test_patch points[POINTS];
    test_patch beside[MOST]; // in the penumbra
    test_stage s = open_quad(context, false, screen);
    for (uint32_t i = 0; i < MOST; i++) {
        beside[i] = test_point((vec3){-0.7f, 0, 0}, UP);
    }
    for (uint32_t count = 1; count <= MOST; count++) {
        check_rays(&s, beside, count, 24);
    }
    scatter(points);
    for (uint32_t i = 0; i < POINTS; i++) {
        check_rays(&s, &points[i], 1, 8);
    }
    test_stage_close(&s);
}
