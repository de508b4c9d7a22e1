// SPDX-License-Identifier: MIT
// More samples of direct light, dealt out to the texels of a floor beside a box's shadow.
#include "bake/light/light_samples.h"
#include "base/memory.h"
#include "test_radiant.h"

#include <math.h>
#include <string.h>

enum { FIRST = 8 };

/// A floor of 4 m, and a square of 1 m that hides a sun of 20° from a part of it.
static alp_scene *make_scene(alp_context *context)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "shade");
    alpi_builder_surface(&b, "floor", test_grey(&b, "grey", 0.5, 0.0));
    alpi_builder_quad(&b, (const vec3[4]){{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}});
    alpi_builder_quad(
        &b,
        (const vec3[4]){{-0.5f, 1, 0.5f}, {0.5f, 1, 0.5f}, {0.5f, 1, -0.5f}, {-0.5f, 1, -0.5f}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// What a bake has after its first round.
typedef struct stage {
    alp_context *context;
    test_radiant r;
    alpi_receivers receivers;
    alpi_bake_job job;
    alpi_light_clock clock;
    alpi_light_bake light;
    alpi_light_rounds rounds;
} stage;

static void start(uint32_t workers, stage *s)
{
    *s = (stage){.context = test_context(workers)};
    alp_lighting_options light = alp_lighting_options_default();
    light.sun = (alp_sun_options){.azimuth = 0.7f,
                                  .elevation = 1.1f,
                                  .illuminance = 10.0f,
                                  .color = {1.0f, 0.9f, 0.8f},
                                  .size = 0.35f};
    test_radiant_options o = test_radiant_default();
    o.lighting = &light;
    o.direct_samples = FIRST;
    test_radiant_open(make_scene(s->context), &o, &s->r);
    s->receivers = alpi_texels_receivers(&s->r.texels);
    s->job.context = s->context;
    s->light = (alpi_light_bake){.job = &s->job,
                                 .receivers = &s->receivers,
                                 .order = s->r.lattice.order,
                                 .count = s->r.texels.count,
                                 .lattice = &s->r.lattice,
                                 .clock = &s->clock};
    s->light.settings.most_rays = 65536;
    s->rounds = (alpi_light_rounds){
        .light = &s->light, .solution = &s->r.solution, .direct = {.most = FIRST, .power = 0.6}};
    s->rounds.fresh.values = ALPI_NEW(s->context, alpi_reference_value, s->light.count);
    s->rounds.direct.counts = ALPI_NEW(s->context, uint32_t, s->light.count);
    assert_true(s->rounds.fresh.values != NULL && s->rounds.direct.counts != NULL);
    for (uint32_t t = 0; t < s->light.count; t++) {
        s->rounds.direct.counts[t] = FIRST;
    }
}

static void finish(stage *s)
{
    alpi_release(s->context, s->rounds.fresh.values);
    alpi_release(s->context, s->rounds.direct.counts);
    test_radiant_close(&s->r);
    alp_context_destroy(s->context);
}

/// Root mean square of what texels' variances state.
static double find_error(const stage *s)
{
    double sum = 0.0;
    for (uint32_t t = 0; t < s->light.count; t++) {
        const float *v = s->r.solution.direct[t].variance;
        sum += ((double)v[0] + (double)v[1] + (double)v[2]) / 3.0;
    }
    return sqrt(sum / s->light.count);
}

static uint64_t count_dealt(const stage *s)
{
    uint64_t sum = 0;
    for (uint32_t t = 0; t < s->light.count; t++) {
        sum += s->rounds.direct.counts[t] - FIRST;
    }
    return sum;
}

static bool deal(stage *s, alpi_light_goal goal)
{
    bool dealt = false;
    ASSERT_OK(s->context, alpi_light_add_samples(&s->rounds, &goal, &dealt));
    return dealt;
}

/// What is predicted comes, about: the noisy get more, those in full light or shade nothing.
TEST(noise_comes_down_to_what_is_wanted)
{
    static stage s;
    start(2, &s);
    const double first = find_error(&s), wanted = 0.2 * first;
    assert_true(deal(&s, (alpi_light_goal){.wanted = wanted, .most = HUGE_VAL, .seed = 5}));
    const double then = find_error(&s);
    print_message("%.4g to %.4g, wanted %.4g, predicted %.4g, %.1f samples a texel\n", first, then,
                  wanted, s.rounds.direct.predicted, (double)count_dealt(&s) / s.light.count);
    assert_true(s.rounds.direct.predicted <= wanted && s.rounds.direct.predicted > 0.8 * wanted);
    ASSERT_NEAR(then / s.rounds.direct.predicted, 1.0, 0.25);
    uint32_t least = UINT32_MAX, most = 0;
    for (uint32_t t = 0; t < s.light.count; t++) {
        least = s.rounds.direct.counts[t] < least ? s.rounds.direct.counts[t] : least;
        most = s.rounds.direct.counts[t] > most ? s.rounds.direct.counts[t] : most;
    }
    assert_int_equal(least, FIRST);
    assert_int_equal(most, s.rounds.direct.most);
    assert_true(most >= 64);
    finish(&s);
}

/// Of texels that are left out, only those beside others get any.
TEST(some_texels_count_alone)
{
    static stage s;
    start(1, &s);
    const double wanted = 0.2 * find_error(&s);
    uint8_t *among = ALPI_NEW(s.context, uint8_t, s.light.count);
    assert_non_null(among);
    assert_false(
        deal(&s, (alpi_light_goal){.wanted = wanted, .most = HUGE_VAL, .seed = 5, .among = among}));
    assert_true(count_dealt(&s) == 0);
    uint32_t noisiest = 0;
    for (uint32_t t = 0; t < s.light.count; t++) {
        const bool more =
            s.r.solution.direct[t].variance[0] > s.r.solution.direct[noisiest].variance[0];
        noisiest = more ? t : noisiest;
    }
    among[noisiest] = 1;
    assert_true(
        deal(&s, (alpi_light_goal){.wanted = wanted, .most = HUGE_VAL, .seed = 5, .among = among}));
    uint32_t got = 0;
    for (uint32_t t = 0; t < s.light.count; t++) {
        got += s.rounds.direct.counts[t] > FIRST;
    }
    assert_true(s.rounds.direct.counts[noisiest] > FIRST && got <= 9);
    alpi_release(s.context, among);
    finish(&s);
}

TEST(workers_change_nothing)
{
    static const uint32_t workers[3] = {1, 2, 7};
    static stage s[3];
    for (int i = 0; i < 3; i++) {
        start(workers[i], &s[i]);
        const double wanted = 0.3 * find_error(&s[i]);
        assert_true(deal(&s[i], (alpi_light_goal){.wanted = wanted, .most = HUGE_VAL, .seed = 5}));
        const size_t count = s[0].light.count;
        assert_int_equal(s[i].light.count, count);
        assert_memory_equal(s[i].r.solution.direct, s[0].r.solution.direct,
                            count * sizeof *s[0].r.solution.direct);
        assert_memory_equal(s[i].rounds.direct.counts, s[0].rounds.direct.counts,
                            count * sizeof *s[0].rounds.direct.counts);
        assert_true(s[i].rounds.direct.predicted == s[0].rounds.direct.predicted);
    }
    for (int i = 0; i < 3; i++) {
        finish(&s[i]);
    }
}

/// Values of the first round stay as they are, to the bit.
static void expect_nothing(stage *s, alpi_light_goal goal)
{
    const size_t size = s->light.count * sizeof *s->r.solution.direct;
    alpi_reference_value *before = ALPI_NEW(s->context, alpi_reference_value, s->light.count);
    assert_non_null(before);
    memcpy(before, s->r.solution.direct, size);
    assert_false(deal(s, goal));
    assert_memory_equal(before, s->r.solution.direct, size);
    assert_true(count_dealt(s) == 0 && s->rounds.direct.most == FIRST);
    alpi_release(s->context, before);
}

TEST(nothing_is_dealt_where_nothing_may_be)
{
    static stage s;
    start(1, &s);
    const double first = find_error(&s);
    const alpi_light_goal good = {.wanted = 100.0 * first, .most = HUGE_VAL, .seed = 5};
    const alpi_light_goal bad = {.wanted = 0.1 * first, .most = HUGE_VAL, .seed = 5};
    expect_nothing(&s, good); // no texel is noisy
    s.light.settings.most_rays = FIRST;
    expect_nothing(&s, bad);
    s.light.settings.most_rays = FIRST + 7; // not even eight more
    expect_nothing(&s, bad);
    finish(&s);
}

/// No texel has more than the limit, nor all together more than they may: few enough are listed for
/// all of them to be asked.
TEST(limits_hold)
{
    static stage s;
    start(1, &s);
    const double wanted = 0.01 * find_error(&s);
    s.light.settings.most_rays = 43;
    for (int round = 0; round < 4; round++) {
        deal(&s, (alpi_light_goal){.wanted = wanted, .most = HUGE_VAL, .seed = 5});
    }
    assert_int_equal(s.rounds.direct.most, 40); // in eights
    finish(&s);
    start(1, &s);
    const double most = 16.0 * s.light.count;
    assert_true(deal(&s, (alpi_light_goal){.wanted = wanted, .most = most, .seed = 5}));
    const double dealt = (double)count_dealt(&s);
    assert_true(dealt <= most && dealt > 0.5 * most);
    finish(&s);
}

static uint32_t count_above(const stage *s, double error)
{
    uint32_t above = 0;
    for (uint32_t t = 0; t < s->light.count; t++) {
        above += (double)s->r.solution.direct[t].variance[0] > error * error;
    }
    return above;
}

/// For the worst texels, each by itself comes to what is wanted: the more is known of it, the
/// nearer.
TEST(each_comes_to_what_is_wanted)
{
    static stage s;
    start(2, &s);
    const double wanted = find_error(&s);
    const uint32_t before = count_above(&s, 1.2 * wanted);
    for (uint64_t round = 0; round < 3; round++) {
        const alpi_light_goal goal = {
            .wanted = wanted, .each = true, .most = HUGE_VAL, .seed = round};
        assert_true(deal(&s, goal));
    }
    const uint32_t after = count_above(&s, 1.2 * wanted);
    print_message("%u of %u texels too noisy, then %u\n", before, s.light.count, after);
    assert_true(before > 100 && after < before / 20);
    finish(&s);
}
