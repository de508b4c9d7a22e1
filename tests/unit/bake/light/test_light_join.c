// SPDX-License-Identifier: MIT
// Direct and bounced light joined, with the noise of the solution that rays read.
#include "bake/light/light_error.h"

#include "base/memory.h"
#include "test_support.h"

enum { TEXELS = 3, RAYS = 64 };

static const double NOISE = 0.125; // of RAYS: 1 / √64

typedef struct solved {
    alpi_gatherer gatherer;
    alpi_radiosity solution;
} solved;

static void solve(solved *s, uint32_t bounces)
{
    *s = (solved){.gatherer = {.packet_count = RAYS / ALPI_PACKET}};
    s->solution.options = (alpi_radiosity_options){.bounces = bounces, .gatherer = &s->gatherer};
}

/// 1.6 % of the mean over the root of the rays of blocks, and not more than 16 % of what is bounced
/// over that; nothing where rays meet direct light alone, and in the dark.
TEST(of_all_light)
{
    solved s;
    solve(&s, UINT32_MAX);
    ASSERT_NEAR(alpi_light_solved_error(&s.solution, 5.0, 2.0, NOISE), 0.002, 1e-9);
    ASSERT_NEAR(alpi_light_solved_error(&s.solution, 5.0, 0.05, NOISE), 0.0002, 1e-9);
    assert_true(alpi_light_solved_error(&s.solution, 5.0, 0.0, NOISE) == 0.0);
    assert_true(alpi_light_solved_error(&s.solution, 0.0, 0.0, NOISE) == 0.0);
    solve(&s, 1);
    assert_true(alpi_light_solved_error(&s.solution, 5.0, 2.0, NOISE) == 0.0);
    solve(&s, 2);
    ASSERT_NEAR(alpi_light_solved_error(&s.solution, 5.0, 2.0, NOISE), 0.002, 1e-9);
    alpi_lighting *sky = (alpi_lighting *)&s; // another than what is looked for directly
    solve(&s, 1);
    s.solution.options.lighting = sky;
    ASSERT_NEAR(alpi_light_solved_error(&s.solution, 5.0, 2.0, NOISE), 0.002, 1e-9);
}

/// Each texel gets its part by what is bounced of its light, a sky's left out: what gets none is
/// known as well as before. Texels that are not of the order are left alone.
TEST(of_each_texel)
{
    alpi_reference_value values[TEXELS] = {
        {{2.0f, 3.0f, 1.0f}, {0.5f, 0.0f, 0.0f}}, {{9, 9, 9}, {0, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}};
    const float skies[TEXELS][3] = {{1.0f, 3.0f, 0.0f}, {0, 0, 0}, {0, 0, 0}};
    const uint32_t order[2] = {0, 2};
    alpi_reference_value whole[TEXELS] = {{{0.0f}, {0.0f}}};
    alpi_bake_job job = {.context = test_context(1), .options = alp_bake_options_default()};
    const alpi_light_bake light = {.job = &job, .order = order, .count = 2, .values = values};
    solved s;
    solve(&s, UINT32_MAX);
    job.options.light.direct = ALP_DIRECT_OFF;
    ASSERT_OK(job.context, alpi_light_join(&light, &s.solution, skies, 0.5, whole));
    ASSERT_NEAR(whole[0].variance[0], 0.75, 1e-6);
    assert_true(whole[0].variance[1] == 0.0f);
    ASSERT_NEAR(whole[0].variance[2], 0.25, 1e-6);
    ASSERT_OK(job.context, alpi_light_join(&light, &s.solution, NULL, 0.5, whole));
    ASSERT_NEAR(whole[0].variance[0], 1.5, 1e-6);
    alp_context_destroy(job.context);
    for (int k = 0; k < 3; k++) {
        assert_true(whole[1].variance[k] == 0.0f && whole[2].variance[k] == 0.0f);
    }
}

/// Light joined in place is light joined apart, over ranges of many texels, with direct light and
/// without.
TEST(light_is_joined_in_place)
{
    enum { MANY = 9000 };
    static alpi_reference_value values[MANY], direct[MANY], whole[MANY];
    static float skies[MANY][3];
    static uint32_t order[MANY];
    solved s;
    solve(&s, UINT32_MAX);
    s.solution.direct = direct;
    for (int on = 0; on < 2; on++) {
        for (uint32_t i = 0; i < MANY; i++) {
            const float x = (float)i;
            values[i] = (alpi_reference_value){{x + 3, x + 2, x + 1}, {1, x, 0}};
            direct[i] = (alpi_reference_value){{2 * x, 0, 1}, {x, 2, 0.5f}};
            skies[i][0] = skies[i][1] = 1.0f;
            order[i] = MANY - 1 - i;
        }
        alpi_bake_job job = {.context = test_context(2), .options = alp_bake_options_default()};
        job.options.light.direct = on != 0 ? ALP_DIRECT_ON : ALP_DIRECT_OFF;
        const alpi_light_bake light = {
            .job = &job, .order = order, .count = MANY, .values = values};
        const float(*sky)[3] = (const float(*)[3])skies;
        ASSERT_OK(job.context, alpi_light_join(&light, &s.solution, sky, 0.5, whole));
        ASSERT_OK(job.context, alpi_light_join(&light, &s.solution, sky, 0.5, values));
        assert_memory_equal(values, whole, sizeof values);
        ASSERT_NEAR(values[4].mean[0], on != 0 ? 15.0 : 6.0, 1e-6);
        ASSERT_NEAR(values[4].variance[0], on != 0 ? 14.0 : 10.0, 1e-6);
        alp_context_destroy(job.context);
    }
}
