// SPDX-License-Identifier: MIT
// A trial by few rays: what it tells of the light, and that the solution after it, whose first rays
// they are, is the one without a trial, by the rays that were chosen.
#include "test_radiant.h"
#include "test_scenes.h"

#include <math.h>

enum { FEW = 16, MANY = 64 };

static const vec3 ZERO = {0, 0, 0}, HALF = {0.5f, 0.5f, 0.5f};
static alp_context *context;

static int setup(void **state)
{
    (void)state;
    context = test_context(2);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    alp_context_destroy(context);
    return 0;
}

/// A room without a ceiling, a lamp in its left half, and a sheet in its middle whose back alone
/// faces the lamp: backs are seen, and lit.
static alp_scene *make_room(void)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "room");
    alpi_builder_surface(&b, "room", alpi_builder_material(&b, "room", HALF, ZERO));
    alpi_builder_box(&b, (vec3){1, 1, 1}, (vec3){-1, 0, 0},
                     ALPI_FACE_ALL & ~(unsigned)ALPI_FACE_TOP);
    alpi_builder_surface(&b, "sheet", alpi_builder_material(&b, "sheet", HALF, ZERO));
    alpi_builder_quad(&b, (const vec3[4]){{0, 0, 0}, {0, 0.7f, 0}, {0, 0.7f, 1}, {0, 0, 1}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    scene->materials[1].double_sided = true;
    test_lit_set_lamps(scene,
                       &(alpi_light){.kind = ALP_LIGHT_POINT,
                                     .color = {1, 1, 1},
                                     .intensity = 1.0f,
                                     .position = {-0.4f, 0.6f, 0.3f},
                                     .range = INFINITY},
                       1);
    return scene;
}

static alp_lighting_options two_skies(void)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_HEMISPHERE;
    for (int k = 0; k < 3; k++) {
        o.sky.up[k] = 1.0f;
        o.sky.down[k] = 0.25f;
    }
    return o;
}

/// What a trial was told, and what it shall say.
typedef struct choice {
    const alpi_gatherer *chosen;
    alpi_trial_light found;
    int asked;
} choice;

static const alpi_gatherer *choose(void *user, const alpi_trial_light *found)
{
    choice *c = user;
    c->found = *found;
    c->asked++;
    return c->chosen;
}

static alpi_gatherer gatherer_of(alpi_cosine_rays *rays, uint32_t samples)
{
    *rays = (alpi_cosine_rays){.context = context, .samples = samples, .replicates = 1, .seed = 1};
    return alpi_cosine_rays_gatherer(rays);
}

static void assert_same_light(const test_radiant *a, const test_radiant *b)
{
    const alpi_patches *p = &a->solution.patches, *q = &b->solution.patches;
    assert_int_equal(a->texels.count, b->texels.count);
    assert_true(p->two_sided && q->two_sided);
    assert_int_equal(a->solution.receiver_count, b->solution.receiver_count);
    assert_memory_equal(p->cells, q->cells,
                        (ALPI_CELL_FIRST + 2 * (size_t)a->texels.count) * sizeof *p->cells);
    assert_int_equal(a->solution.passes, b->solution.passes);
    assert_true(a->solution.passes <= ALPI_RADIOSITY_CHANGES);
    assert_memory_equal(a->solution.changes, b->solution.changes,
                        a->solution.passes * sizeof *a->solution.changes);
    assert_true(a->solution.energy.escaped == b->solution.energy.escaped);
    assert_true(a->solution.energy.absorbed == b->solution.energy.absorbed);
    assert_true(p->seen_backs != NULL && q->seen_backs != NULL);
    assert_memory_equal(p->seen_backs, q->seen_backs, p->block_count);
}

/// @param kept whether rays are kept
static void try_room(bool kept)
{
    const alp_lighting_options sky = two_skies();
    alpi_cosine_rays few, many;
    const alpi_gatherer trial = gatherer_of(&few, FEW), more = gatherer_of(&many, MANY);
    for (int enough = 0; enough < 2; enough++) {
        test_radiant plain, tried;
        test_radiant_options o = test_radiant_default();
        o.lighting = &sky;
        o.soft_sky = true;
        o.kept_limit = kept ? o.kept_limit : 0;
        o.rays = enough ? FEW : MANY;
        test_radiant_open(make_room(), &o, &plain);
        choice c = {.chosen = enough ? NULL : &more};
        o.trial = (alpi_radiosity_trial){&trial, choose, &c};
        test_radiant_open(make_room(), &o, &tried);
        assert_int_equal(c.asked, 1);
        assert_true(plain.solution.kept == kept && tried.solution.kept == kept);
        assert_int_equal(c.found.blocks, tried.solution.receiver_count);
        assert_true(c.found.blocks > tried.solution.patches.block_count); // backs too
        assert_true(tried.solution.options.gatherer == (enough ? &trial : &more));
        assert_same_light(&plain, &tried);
        // Kept, they are sent once; else there are those of the trial's own passes.
        const uint64_t trial_rays = enough || kept ? 0 : (uint64_t)FEW * c.found.blocks;
        assert_true(kept ? tried.solution.rays == plain.solution.rays
                         : tried.solution.rays >= plain.solution.rays + trial_rays);
        test_radiant_close(&plain);
        test_radiant_close(&tried);
    }
}

static void solutions_after_a_trial_are_those_without(void **state)
{
    (void)state;
    try_room(true);
    try_room(false);
}

/// Peak memory of the room, solved with a trial or without.
/// @param kept_limit of rays  @param room out: who there is room for  @param rays out: that were
/// sent
static uint64_t peak_of(bool tried, uint64_t kept_limit, uint64_t *room, uint64_t *rays)
{
    alp_context *outer = context;
    context = test_context(1);
    alpi_cosine_rays few, many;
    const alpi_gatherer trial = gatherer_of(&few, FEW), more = gatherer_of(&many, MANY);
    choice c = {.chosen = &more};
    test_radiant r;
    test_radiant_options o = test_radiant_default();
    o.trial = (alpi_radiosity_trial){tried ? &trial : NULL, choose, &c};
    o.kept_limit = kept_limit;
    test_radiant_open(make_room(), &o, &r);
    assert_true(r.solution.kept);
    *room = 2 * (uint64_t)r.solution.patches.block_count;
    *rays = r.solution.rays;
    test_radiant_close(&r);
    const uint64_t peak = alp_context_peak_memory(context);
    alp_context_destroy(context);
    context = outer;
    return peak;
}

/// The rays of a trial are the first of those that were chosen, where there is room for both while
/// they move; else they are gone before: no more memory than without, but for what asks and is
/// asked.
static void a_trial_keeps_to_the_limit(void **state)
{
    (void)state;
    enum { RAY = sizeof(uint32_t), ASKED = 4096 };
    const uint64_t enough = test_radiant_default().kept_limit;
    uint64_t room, sent[4];
    const uint64_t plain = peak_of(false, enough, &room, &sent[0]);
    assert_true(room * FEW * RAY > 4 * (uint64_t)ASKED); // else nobody would see it
    assert_true(peak_of(true, enough, &room, &sent[1]) < plain + room * FEW * RAY + ASKED);
    assert_true(peak_of(true, room * (MANY + FEW) * RAY - 1, &room, &sent[2]) < plain + ASKED);
    assert_true(peak_of(true, room * (MANY + FEW) * RAY, &room, &sent[3]) <
                plain + room * FEW * RAY + ASKED);
    assert_true(sent[1] == sent[0] && sent[3] == sent[0] && sent[2] > sent[0]);
}

/// In a closed room of reflectance ρ all of whose walls shine, what bounced is ρ of all light,
/// everywhere.
static void trials_tell_how_much_bounced(void **state)
{
    (void)state;
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_cosine_rays few;
    const alpi_gatherer trial = gatherer_of(&few, FEW);
    test_radiant r;
    test_radiant_options o = test_radiant_default();
    choice c = {.chosen = NULL};
    o.trial = (alpi_radiosity_trial){&trial, choose, &c};
    alpi_builder_start(&b, context, "furnace");
    alpi_builder_surface(&b, "room", test_grey(&b, "room", 0.5, 1.0));
    alpi_builder_box(&b, (vec3){1, 1, 1}, ZERO, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    test_radiant_open(scene, &o, &r);
    // Direct light has noise of 256 samples, and at edges texels that see half of their own wall.
    ASSERT_NEAR(c.found.mean, 0.5, 2e-3);
    ASSERT_NEAR(c.found.rms, 0.5, 2e-3);
    assert_int_equal(c.found.blocks, r.solution.patches.block_count);
    test_radiant_close(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_OF_FIGURES(solutions_after_a_trial_are_those_without),
        cmocka_unit_test(a_trial_keeps_to_the_limit),
        cmocka_unit_test(trials_tell_how_much_bounced),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
