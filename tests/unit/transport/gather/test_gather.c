// SPDX-License-Identifier: MIT
// What rays of gatherers bring back: surfaces from both sides, panes, sky, and neither lamps nor
// suns; and how hemicubes are asked: turns, receivers, cancelling.
#include "test_probe.h"

#include "base/memory.h"

#include <string.h>

static const vec3 BLACK = {0, 0, 0}, ONE = {1, 1, 1}, UP = {0, 1, 0};
/// Faces the origin.
static const vec3 SMALL[4] = {
    {-0.2f, 2, -0.2f}, {0.2f, 2, -0.2f}, {0.2f, 2, 0.2f}, {-0.2f, 2, 0.2f}};
TEST_CONTEXT(1);

// --- what rays meet ------------------------------------------------------------------------------

static void reflect_half(const void *user, const alpi_surface_point *points, uint32_t count,
                         vec3 *radiance)
{
    (void)points;
    const float *share = user;
    assert_true(count >= 1 && count <= ALPI_PACKET);
    for (uint32_t i = 0; i < count; i++) {
        radiance[i] = (vec3){*share, 2.0f * *share, 0.0f};
    }
}

/// A closed cube of radiance 1 that reflects ½ besides: what is emitted, what is reflected, both.
TEST(a_closed_room_is_exact)
{
    const float half = 0.5f;
    alp_scene *scene = test_load(context, "builtin:furnace");
    test_probe p = test_probe_open(context, scene, NULL, 6);
    const alpi_receiver_point point = test_probe_point((vec3){0.25f, 0.0f, 0.125f}, UP);
    float e[3];
    ASSERT_NEAR(test_probe_gather(&p, &point, 0), ALPI_PI, 2e-7 * ALPI_PI);
    p.options.from.light = (alpi_surface_light){.reflected = reflect_half, .user = &half};
    ASSERT_OK(context, alpi_hemicube_gather(&p.options, &point, 0, e));
    ASSERT_NEAR(e[0], 1.5 * ALPI_PI, 4e-7 * ALPI_PI);
    ASSERT_NEAR(e[1], 2.0 * ALPI_PI, 4e-7 * ALPI_PI);
    ASSERT_NEAR(e[2], 1.0 * ALPI_PI, 4e-7 * ALPI_PI);
    p.options.from.emitters = false;
    ASSERT_NEAR(test_probe_gather(&p, &point, 0), 0.5 * ALPI_PI, 2e-7 * ALPI_PI);
    test_probe_close(&p);
}

/// Light of a scene whose points are looked at: asserts what it is told.
typedef struct watcher {
    const alp_scene *scene;
    vec3 eye;
    bool from_behind;
    uint32_t *asked;
} watcher;

static void watch(const void *user, const alpi_surface_point *points, uint32_t count,
                  vec3 *radiance)
{
    const watcher *w = user;
    for (uint32_t i = 0; i < count; i++) {
        const alpi_surface_point *s = &points[i];
        vec3 c[3];
        alpi_triangle_corners(w->scene, s->triangle, c);
        const float b0 = 1.0f - s->b1 - s->b2;
        const vec3 at = vec3_mad(vec3_mad(vec3_scale(c[0], b0), s->b1, c[1]), s->b2, c[2]);
        const vec3 toward = vec3_normalize_or(vec3_sub(w->eye, at), BLACK);
        ASSERT_NEAR(vec3_length(vec3_sub(toward, s->toward)), 0.0, 1e-5);
        assert_true(s->from_behind == w->from_behind);
        radiance[i] = vec3_scale(ONE, 0.25f);
        ++*w->asked;
    }
}

/// A box of side 2 about the origin, of one black material.
static alp_scene *make_box(bool inside, alpi_material *change)
{
    const vec3 low = {-1, -1, -1};
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "box");
    alpi_builder_surface(&b, "box", alpi_builder_material(&b, "box", BLACK, BLACK));
    alpi_builder_box(&b, inside ? ONE : low, inside ? low : ONE, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    scene->materials[0].double_sided = change->double_sided;
    scene->materials[0].alpha_mode = change->alpha_mode;
    scene->materials[0].base_color[3] = change->base_color[3];
    return scene;
}

/// In a box: walls from inside and from behind, single-sided and not, and of a blended material
/// that lets (1 − a)² of the sky through, as it is black.
TEST(surfaces_are_asked_for_their_light)
{
    static const struct {
        double share; // E / π
        uint32_t asked;
        bool inside, double_sided, one_sided, blended;
    } cases[] = {{0.25, 108, true, false, false, false},
                 {0.0, 0, false, false, false, false},
                 {0.25, 108, false, true, false, false},
                 {1.0, 0, false, false, true, false},
                 {0.3125, 108, true, false, false, true}};
    const alp_lighting_options o = test_sky_of(ALP_SKY_CONSTANT);
    for (int i = 0; i < 5; i++) {
        alpi_material m = alpi_material_default();
        m.double_sided = cases[i].double_sided;
        m.alpha_mode = cases[i].blended ? ALPI_ALPHA_BLEND : ALPI_ALPHA_OPAQUE;
        m.base_color[3] = cases[i].blended ? 0.75f : 1.0f;
        test_probe p = test_probe_open(context, make_box(cases[i].inside, &m), &o, 6);
        uint32_t asked = 0;
        const watcher w = {p.stage.scene, {0.125f, 0.25f, -0.25f}, !cases[i].inside, &asked};
        p.options.from.light = (alpi_surface_light){.reflected = watch, .user = &w};
        p.options.from.filter.one_sided = cases[i].one_sided;
        const alpi_receiver_point point = {w.eye, {0, 0, 1}, {0, 0, 1}, 0.0f};
        ASSERT_NEAR(test_probe_gather(&p, &point, 0), cases[i].share * ALPI_PI, 2e-7 * ALPI_PI);
        assert_int_equal(asked, cases[i].asked);
        test_probe_close(&p);
    }
}

/// Lamps and suns, however large, are direct light's.
TEST(lamps_and_suns_are_not_counted)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sun.illuminance = 1000.0f;
    o.sun.elevation = 1.0f;
    o.sun.size = 1.0f;
    alp_scene *scene = test_probe_quad(context, NULL);
    scene->lights = ALPI_NEW(context, alpi_light, 1);
    assert_non_null(scene->lights);
    scene->lights[0] = test_lamp((vec3){0, 2, 0}, 100.0f);
    scene->light_count = 1;
    test_probe p = test_probe_open(context, scene, &o, 16);
    const alpi_receiver_point point = test_probe_point(BLACK, UP);
    assert_true(test_probe_gather(&p, &point, 0) == 0.0);
    test_probe_close(&p);
}

// --- turns, receivers and cancelling -------------------------------------------------------------

static void test_gather_one(const test_probe *p, const alpi_receivers *receivers, uint32_t receiver,
                            float light[3])
{
    const alpi_gatherer gatherer = alpi_hemicube_gatherer(&p->options);
    alpi_reference_value values[2];
    const alpi_gather_job job = {.context = context,
                                 .from = &p->options.from,
                                 .gatherer = &gatherer,
                                 .receivers = receivers,
                                 .list = &receiver,
                                 .count = 1,
                                 .values = values};
    ASSERT_OK(context, alpi_gather_irradiance(&job, NULL));
    memcpy(light, values[receiver].mean, 3 * sizeof *light);
}

/// The turn is the receiver's own, and a gatherer asks at the receiver's middle.
TEST(turns_are_keyed)
{
    test_probe p = test_probe_open(context, test_probe_quad(context, SMALL), NULL, 32);
    const test_patch patches[2] = {{{0.5f, 0, 0}, {0.5f, 0, 0}, {0, 0, 0.25f}, UP},
                                   {{0.5f, 0, 0}, {0.5f, 0, 0}, {0, 0, 0.25f}, UP}};
    const test_patches all = {.count = 2, .patches = patches, .offset = 1e-6f};
    const alpi_receivers receivers = test_patches_receivers(&all);
    const alpi_receiver_point middle = test_probe_point((vec3){0.75f, 0, 0.125f}, UP);
    for (int turned = 0; turned < 2; turned++) {
        float e[2][3];
        p.options.turned = turned != 0;
        for (uint32_t i = 0; i < 2; i++) {
            test_gather_one(&p, &receivers, i, e[i]);
            assert_true((double)e[i][0] == test_probe_gather(&p, &middle, i));
        }
        assert_true((e[0][0] != e[1][0]) == (turned != 0));
    }
    const double first = test_probe_gather(&p, &middle, 0);
    p.options.seed = 2;
    assert_true(test_probe_gather(&p, &middle, 0) != first);
    test_probe_close(&p);
}

/// Smooth shading turns the cube, and not where its rays start.
TEST(the_axis_is_the_shading_normal)
{
    const vec3 tilted = {0.6f, 0.8f, 0.0f};
    test_probe p = test_probe_open(context, test_probe_quad(context, SMALL), NULL, 32);
    const alpi_receiver_point point = {BLACK, UP, tilted, 0.5f};
    const alpi_receiver_point raised = {{0, 0.5f, 0}, UP, tilted, 0.0f};
    const alpi_hemicube_frame f = alpi_hemicube_frame_about(tilted, 0.0f);
    float e[3];
    ASSERT_OK(context, alpi_hemicube_gather_in(&p.options, &raised, &f, e));
    assert_true(e[0] > 0.0f && (double)e[0] == test_probe_gather(&p, &point, 0));
    test_probe_close(&p);
}

enum { RECEIVERS = 24 };

TEST(workers_change_nothing)
{
    static test_patch patches[RECEIVERS];
    static const uint32_t workers[3] = {1, 2, 7};
    static alpi_reference_value made[3][RECEIVERS];
    alp_scene *scene = test_load(context, "builtin:cornell");
    test_probe p = test_probe_open(context, scene, NULL, 16);
    p.options.turned = true;
    for (uint32_t i = 0; i < RECEIVERS; i++) {
        patches[i] = test_point((vec3){0.02f * (float)i + 0.03f, 0, 0.1f}, UP);
    }
    const test_patches all = {.count = RECEIVERS, .patches = patches, .offset = 1e-6f};
    const alpi_receivers receivers = test_patches_receivers(&all);
    for (int k = 0; k < 3; k++) {
        alp_context *own = test_context(workers[k]);
        p.options.context = own;
        const alpi_gatherer gatherer = alpi_hemicube_gatherer(&p.options);
        const alpi_gather_job job = {.context = own,
                                     .from = &p.options.from,
                                     .gatherer = &gatherer,
                                     .receivers = &receivers,
                                     .count = RECEIVERS,
                                     .values = made[k]};
        ASSERT_OK(own, alpi_gather_irradiance(&job, NULL));
        assert_memory_equal(made[k], made[0], sizeof made[0]);
        alp_context_destroy(own);
    }
    assert_true(made[0][RECEIVERS - 1].mean[0] > 0.0f);
    test_probe_close(&p);
}

static bool refuse(void *user, const alp_progress *progress)
{
    (void)progress;
    return ++*(uint32_t *)user < 3;
}

static alp_result gather_always(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)begin;
    (void)end;
    (void)worker;
    const test_probe *p = user;
    const alpi_receiver_point point = test_probe_point(BLACK, UP);
    float e[3];
    for (;;) {
        const alp_result result = alpi_hemicube_gather(&p->options, &point, 0, e);
        if (result != ALP_OK) {
            return result;
        }
    }
}

TEST(one_cube_can_be_cancelled)
{
    uint32_t calls = 0;
    test_probe p = test_probe_open(context, test_probe_quad(context, SMALL), NULL, 64);
    const alpi_task_progress told = {.callback = refuse, .user = &calls, .stage = "gather"};
    assert_int_equal(alpi_parallel_for(context, 1, 1, gather_always, &p, &told),
                     ALP_ERROR_CANCELLED);
    test_probe_close(&p);
}
