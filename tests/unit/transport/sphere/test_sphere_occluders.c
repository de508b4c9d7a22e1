// SPDX-License-Identifier: MIT
// Black spheres that stop the rays of kept hits: closed forms, and which rays pass.
#include "test_lit.h"

#include "scene/builtin/mesh_builder.h"
#include "transport/sphere/sphere_hits.h"

TEST_CONTEXT(1);

enum { FACE = 16, HITS = 6 * FACE * FACE, KEYS = 16 };
static const double Y0 = 0.28209479, Y1 = 0.48860251;
static const float ALBEDO = 0.64f; // (204/255)²: hits keep it exactly

/// A quad of `half` metres to either side at height 0, seen from above.
static alp_scene *floor_scene(float half, float albedo, float emission)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 color = {albedo, albedo, albedo}, glow = {emission, emission, emission};
    alpi_builder_start(&b, context, "floor");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "floor", color, glow));
    alpi_builder_quad(&b, (const vec3[4]){{-half, 0.0f, half},
                                          {half, 0.0f, half},
                                          {half, 0.0f, -half},
                                          {-half, 0.0f, -half}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

static alpi_sphere_relight relight_of(const test_lit *lit, const alpi_occluders *occluders)
{
    return (alpi_sphere_relight){.context = lit->scene->context,
                                 .scene = lit->scene,
                                 .tracer = lit->tracer,
                                 .lighting = lit->lighting,
                                 .occluders = occluders,
                                 .seed = 1};
}

static alpi_occluders ball(float height, float radius)
{
    return (alpi_occluders){.count = 1, .centres = {{0.0f, height, 0.0f}}, .radii = {radius}};
}

/// Channel 0 of the light, as a mean over keys.
static alpi_sh9 mean_light(const alpi_sphere_relight *how, float height, bool direct)
{
    alpi_sh9 mean = {0};
    for (uint32_t key = 0; key < KEYS; key++) {
        alpi_sphere_hits_point at = {
            .point = {0.0f, height, 0.0f}, .key = key, .face = FACE, .direct = direct};
        ASSERT_OK(how->context, alpi_sphere_hits_gather(how, &at, 1, NULL));
        for (int i = 0; i < ALPI_SH9_COUNT; i++) {
            mean.c[i][0] += at.value.light.c[i][0] / (float)KEYS;
        }
    }
    return mean;
}

TEST(a_ball_covers_its_cap_of_the_sky)
{
    alp_lighting_options o = alp_lighting_options_default();
    const alpi_occluders one = ball(6.0f, 1.0f);
    o.sky.kind = ALP_SKY_CONSTANT;
    test_lit lit = test_lit_open(floor_scene(1e-4f, 0.0f, 0.0f), &o);
    const alpi_sphere_relight how = relight_of(&lit, &one);
    const alpi_sh9 light = mean_light(&how, 3.0f, false);
    const double cosine = sqrt(8.0) / 3.0;
    ASSERT_NEAR(light.c[0][0], Y0 * (4.0 * ALPI_PI - 2.0 * ALPI_PI * (1.0 - cosine)), 0.002);
    ASSERT_NEAR(light.c[1][0], -Y1 * ALPI_PI / 9.0, 0.01);
    test_lit_close(&lit);
}

/// The sun from above: under the ball lies a shadow of its radius, half a right angle wide.
TEST(a_ball_casts_a_shadow_of_the_sun)
{
    alp_lighting_options o = alp_lighting_options_default();
    const alpi_occluders one = ball(5.0f, 1.0f);
    o.sun.illuminance = 3.0f;
    o.sun.elevation = (float)(0.5 * ALPI_PI);
    o.sun.size = 0.0f;
    test_lit lit = test_lit_open(floor_scene(2000.0f, ALBEDO, 0.0f), &o);
    const alpi_sphere_relight how = relight_of(&lit, &one);
    const double radiance = (double)ALBEDO * 3.0 / ALPI_PI;
    ASSERT_NEAR(mean_light(&how, 1.0f, false).c[0][0], Y0 * radiance * 2.0 * ALPI_PI * sqrt(0.5),
                0.01 * radiance);
    test_lit_close(&lit);
}

/// A lamp at 3 m: the ball at 2 m shades a disk of the floor, and the lamp itself at 1 m.
TEST(a_ball_casts_a_shadow_of_a_lamp)
{
    alp_lighting_options o = alp_lighting_options_default();
    alp_lamp lamp = alp_lamp_default();
    const alpi_occluders one = ball(2.0f, 0.5f);
    lamp.intensity = 10.0f;
    lamp.position[1] = 3.0f;
    o.lamps = &lamp;
    o.lamp_count = 1;
    test_lit lit = test_lit_open(floor_scene(2000.0f, ALBEDO, 0.0f), &o);
    const alpi_sphere_relight how = relight_of(&lit, &one), bare = relight_of(&lit, NULL);
    double expected = 0.0;
    const double step = 1e-3, shade = 3.0 * 0.5 / sqrt(0.75);
    for (double r = shade + 0.5 * step; r < 100.0; r += step) {
        const double radiance = (double)ALBEDO / ALPI_PI * 10.0 * 3.0 / pow(9.0 + r * r, 1.5);
        expected += step * Y0 * radiance * 2.0 * ALPI_PI * r / pow(1.0 + r * r, 1.5);
    }
    const alpi_sh9 shaded = mean_light(&how, 1.0f, false);
    ASSERT_NEAR(shaded.c[0][0], expected, 0.02 * expected);
    // Straight from the lamp comes nothing; without the ball, I / d² does.
    ASSERT_NEAR(mean_light(&how, 1.0f, true).c[0][0], shaded.c[0][0], 1e-6);
    ASSERT_NEAR(mean_light(&bare, 1.0f, true).c[0][0] - mean_light(&bare, 1.0f, false).c[0][0],
                Y0 * 10.0 / 4.0, 1e-3);
    test_lit_close(&lit);
}

static void bounce_one(const void *user, uint32_t count, const vec3 *points, const vec3 *normals,
                       vec3 *irradiance)
{
    (void)user;
    (void)points;
    (void)normals;
    for (uint32_t i = 0; i < count; i++) {
        irradiance[i] = (vec3){1.0f, 1.0f, 1.0f};
    }
}

TEST(a_ball_hides_what_lies_behind)
{
    const alpi_occluders one = ball(1.5f, 0.5f);
    test_lit lit = test_lit_open(floor_scene(2000.0f, ALBEDO, 0.0f), NULL);
    alpi_sphere_relight how = relight_of(&lit, &one);
    how.bounce = bounce_one;
    const double radiance = (double)ALBEDO / ALPI_PI, cap = 2.0 * ALPI_PI * (1.0 - sqrt(8.0) / 3.0);
    ASSERT_NEAR(mean_light(&how, 3.0f, false).c[0][0], Y0 * radiance * (2.0 * ALPI_PI - cap),
                0.01 * radiance);
    test_lit_close(&lit);
}

/// A small surface that shines lies behind a ball, for rays that are aimed at it and that meet it.
TEST(a_ball_hides_what_shines)
{
    for (int aimed = 0; aimed < 2; aimed++) {
        const alpi_occluders before = ball(1.0f, 0.3f), beside = ball(3.0f, 0.3f);
        test_lit lit = test_lit_open(floor_scene(0.1f, 0.0f, 50.0f), NULL);
        alpi_sphere_relight how = relight_of(&lit, &before);
        how.aimed = aimed != 0 ? lit.lighting : NULL;
        ASSERT_NEAR(mean_light(&how, 2.0f, false).c[0][0], 0.0, 0.0);
        how.occluders = &beside; // on the other side
        const double seen = Y0 * 50.0 * 0.04 / 4.0;
        ASSERT_NEAR(mean_light(&how, 2.0f, false).c[0][0], seen, aimed != 0 ? 0.01 : 0.1);
        test_lit_close(&lit);
    }
}

/// Behind surfaces and around the point, spheres stop nothing.
TEST(rays_pass_spheres_that_they_do_not_meet)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_CONSTANT;
    o.sun.illuminance = 3.0f;
    o.sun.elevation = 0.6f;
    const alpi_occluders below = ball(-3.0f, 2.0f), around = ball(1.5f, 1.0f), none = {0};
    const alpi_occluders *all[] = {&below, &around, &none};
    test_lit lit = test_lit_open(floor_scene(100.0f, ALBEDO, 0.0f), &o);
    alpi_sphere_relight how = relight_of(&lit, NULL);
    for (int i = 0; i < 3; i++) {
        how.occluders = NULL;
        const float bare = mean_light(&how, 1.0f, true).c[0][0];
        how.occluders = all[i];
        const float with = mean_light(&how, 1.0f, true).c[0][0];
        // The sphere around the point shades the floor.
        assert_true(i == 1 ? with < bare && with > 0.8f * bare : with == bare);
    }
    test_lit_close(&lit);
}

/// Hits are those of the scene: kept ones, relit, give the bits of new ones.
TEST(relit_hits_follow_a_ball)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_CLEAR;
    o.sun.illuminance = 1e5f;
    o.sun.elevation = 0.9f;
    const alpi_occluders first = ball(3.0f, 1.0f), second = ball(4.0f, 1.5f);
    static alpi_sphere_hit hits[HITS];
    test_lit lit = test_lit_open(floor_scene(50.0f, ALBEDO, 0.0f), &o);
    alpi_sphere_relight how = relight_of(&lit, &first);
    alpi_sphere_hits_point kept = {.point = {0.5f, 1.0f, 0.0f}, .face = FACE, .hits = hits};
    alpi_sphere_hits_point fresh = {.point = {0.5f, 1.0f, 0.0f}, .face = FACE};
    ASSERT_OK(context, alpi_sphere_hits_gather(&how, &kept, 1, NULL));
    const float before = kept.value.light.c[0][1];
    how.occluders = &second;
    kept.traced = true;
    ASSERT_OK(context, alpi_sphere_hits_gather(&how, &kept, 1, NULL));
    ASSERT_OK(context, alpi_sphere_hits_gather(&how, &fresh, 1, NULL));
    assert_memory_equal(&kept.value, &fresh.value, sizeof fresh.value);
    assert_true(kept.value.light.c[0][1] != before);
    test_lit_close(&lit);
}
