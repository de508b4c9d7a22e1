// SPDX-License-Identifier: MIT
// Ambience and spheres that move.
#include "ambience_world.h"
#include "field_scenes.h"

TEST_CONTEXT(2);

static const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};

/// An even sky of radiance 1, and nothing else to speak of.
typedef struct air {
    alp_scene *scene;
    alp_ambience *ambience;
    alp_ambience_sampler *sampler;
} air;

static air open_air(void)
{
    alp_ambience_options a = alp_ambience_options_default();
    alp_ambience_sampler_options o = alp_ambience_sampler_options_default();
    air v = {.scene = field_specks(context)};
    a.size = 27.0;
    a.depth = 3;
    a.anchor_limit = 65536;
    o.lighting.sky.kind = ALP_SKY_CONSTANT;
    o.face = o.first_face = 8;
    ASSERT_OK(context, alp_ambience_create(context, &a, &v.ambience));
    ASSERT_OK(context, alp_ambience_sampler_create(v.ambience, v.scene, &o, &v.sampler));
    for (int k = 0; k < 3; k++) { // anchors at whole metres, far beyond the specks
        v.ambience->options.centre[k] = 0.0;
        v.ambience->bounds_min[k] = -HUGE_VAL;
        v.ambience->bounds_max[k] = HUGE_VAL;
    }
    return v;
}

static void close_air(air *v)
{
    alp_ambience_sampler_destroy(v->sampler);
    alp_ambience_destroy(v->ambience);
    alp_scene_destroy(v->scene);
}

/// Samples all that is wanted, before time moves.
static alp_ambience_work sample_all(const air *v)
{
    alp_ambience_work work;
    ASSERT_OK(context, alp_ambience_update(v->ambience, 0.0));
    ASSERT_OK(context, alp_ambience_sample(v->sampler, &camera, 100000, 0.0, &work));
    ASSERT_OK(context, alp_ambience_update(v->ambience, 0.0));
    return work;
}

static double read_up(const air *v, double x, double y, double z)
{
    const double place[1][3] = {{x, y, z}};
    const float up[1][3] = {{0.0f, 1.0f, 0.0f}};
    float e[1][3];
    const alp_ambience_snapshot *now = alp_ambience_begin_read(v->ambience);
    alp_ambience_irradiance(now, 1, place, up, e);
    alp_ambience_end_read(v->ambience, now);
    return (double)e[0][1];
}

/// E = π (1 − r²/d²) = 2.356 under a ball, of which nine coefficients make 2.326.
TEST_SLOW(a_ball_darkens_what_lies_below_and_goes)
{
    static const double spheres[1][4] = {{0.0, 3.0, 0.0, 1.5}};
    air v = open_air();
    const double shaded = 2.326;
    sample_all(&v);
    sample_all(&v);
    ASSERT_NEAR(read_up(&v, 0.0, 0.0, 0.0), ALPI_PI, 0.03);
    ASSERT_OK(context, alp_ambience_sampler_set_occluders(v.sampler, spheres, 1));
    const alp_ambience_work work = sample_all(&v);
    assert_true(work.relit > 100 && work.samples == 0); // kept hits serve
    ASSERT_NEAR(read_up(&v, 0.0, 0.0, 0.0), shaded, 0.08);
    ASSERT_NEAR(read_up(&v, 0.0, 3.0, 0.0), ALPI_PI, 0.03); // in the ball: the air's light
    ASSERT_OK(context, alp_ambience_sampler_set_occluders(v.sampler, NULL, 0));
    sample_all(&v);
    ASSERT_NEAR(read_up(&v, 0.0, 0.0, 0.0), ALPI_PI, 0.03);
    close_air(&v);
}

static uint32_t count_stale(const air *v, double x, double reach, bool inside)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < v->ambience->anchor_end; i++) {
        const alpi_anchor *at = &v->ambience->anchors[i];
        double p[3];
        alpi_anchor_place(v->ambience, at, p);
        const bool near = fabs(p[0] - x) <= reach && fabs(p[1]) <= reach && fabs(p[2]) <= reach;
        count += at->state != ALPI_ANCHOR_FREE && at->stale_light != 0 && near == inside;
    }
    return count;
}

/// Anchors within four radii of a sphere that changed are relit, no others.
TEST(only_anchors_near_spheres_that_change_are_relit)
{
    static const double before[2][4] = {{1.0, 0.0, 0.0, 0.5}, {-4.0, 0.0, 0.0, 0.5}};
    static const double after[2][4] = {{1.0, 0.0, 0.0, 0.25}, {-4.0, 0.0, 0.0, 0.5}};
    air v = open_air();
    sample_all(&v);
    ASSERT_OK(context, alp_ambience_sampler_set_occluders(v.sampler, before, 2));
    for (uint32_t i = 0; i < v.ambience->anchor_end; i++) {
        v.ambience->anchors[i].stale_light = 0;
    }
    ASSERT_OK(context, alp_ambience_sampler_set_occluders(v.sampler, before, 2));
    assert_int_equal(count_stale(&v, 0.0, 1e9, true), 0); // nothing changed
    ASSERT_OK(context, alp_ambience_sampler_set_occluders(v.sampler, after, 2));
    assert_int_equal(count_stale(&v, 1.0, 2.0, true), 125); // the old radius counts
    assert_int_equal(count_stale(&v, 1.0, 2.0, false), 0);
    close_air(&v);
}

TEST(spheres_that_are_none_are_refused)
{
    const double bad[5][4] = {{0.0, 0.0, 0.0, 0.0},
                              {0.0, 0.0, 0.0, -1.0},
                              {(double)NAN, 0.0, 0.0, 1.0},
                              {0.0, 1e300, 0.0, 1.0},
                              {0.0, 0.0, 0.0, HUGE_VAL}};
    const double many[17][4] = {{0.0, 0.0, 0.0, 1.0}};
    air v = open_air();
    for (int i = 0; i < 5; i++) {
        assert_int_equal(alp_ambience_sampler_set_occluders(v.sampler, &bad[i], 1),
                         ALP_ERROR_INVALID_ARGUMENT);
    }
    assert_int_equal(alp_ambience_sampler_set_occluders(v.sampler, many, 17),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_ambience_sampler_set_occluders(v.sampler, NULL, 1),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_ambience_sampler_set_occluders(NULL, many, 1), ALP_ERROR_INVALID_ARGUMENT);
    close_air(&v);
}
