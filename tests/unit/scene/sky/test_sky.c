// SPDX-License-Identifier: MIT
// Even and two-coloured skies against closed forms; what is refused, and how.
#include "sky_checks.h"

#include <math.h>

static const vec3 UP = {0.0f, 1.0f, 0.0f};

TEST_WITH_CONTEXT(a_constant_sky_gives_pi_times_its_radiance, 1)
{
    alp_sky_options o = sky_options(ALP_SKY_CONSTANT);
    vec3_store(o.up, (vec3){0.25f, 2.0f, 0.0f});
    vec3_store(o.down, (vec3){7.0f, 7.0f, 7.0f}); // not looked at
    o.strength = 4.0f;
    o.turn = 1.0f;
    alpi_sky *sky = sky_make(context, &o, UP);
    const double expected[3] = {1.0, 8.0, 0.0};
    const vec3 normals[] = {UP, {0.6f, -0.8f, 0.0f}};
    for (int n = 0; n < 2; n++) {
        double irradiance[3], error[3];
        sky_irradiance_drawn(sky, normals[n], 100000, irradiance, error);
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(irradiance[k], ALPI_PI * expected[k], 4.0 * error[k]);
        }
    }
    for (int i = 0; i < 100; i++) {
        vec3 d = sky_polar(0.0314 * i, 0.7 * i), radiance = alpi_sky_radiance(sky, d);
        ASSERT_NEAR(radiance.x, 1.0, 1e-6); // (1 − s) L + s L in floats
        ASSERT_NEAR(radiance.y, 8.0, 8e-6);
        ASSERT_NEAR(radiance.z, 0.0, 0.0);
        ASSERT_NEAR(alpi_sky_density(sky, d), 0.25 / ALPI_PI, 1e-8);
    }
    ASSERT_NEAR(alpi_sky_mean(sky).y, 8.0, 0.0);
    sky_check_density(sky, 64);
    alpi_sky_destroy(context, sky);
}

/// Oracle 2: E = π (up (1 + cos t) + down (1 − cos t)) / 2.
TEST_WITH_CONTEXT(a_hemisphere_sky_at_every_tilt, 1)
{
    alp_sky_options o = sky_options(ALP_SKY_HEMISPHERE);
    const float up[3] = {1.0f, 3.0f, 0.0f}, down[3] = {0.5f, 0.0f, 2.0f};
    memcpy(o.up, up, sizeof up);
    memcpy(o.down, down, sizeof down);
    o.strength = 2.0f;
    alpi_sky *sky = sky_make(context, &o, UP);
    for (int i = 0; i <= 6; i++) {
        double tilt = ALPI_PI * i / 6.0, drawn[3], error[3], sum[3];
        vec3 normal = sky_polar(tilt, 0.4);
        sky_irradiance_drawn(sky, normal, 40000, drawn, error);
        sky_irradiance_sum(sky, normal, 128, sum);
        for (int k = 0; k < 3; k++) {
            double u = 2.0 * (double)up[k], d = 2.0 * (double)down[k];
            double exact = ALPI_PI * (u * (1.0 + cos(tilt)) + d * (1.0 - cos(tilt))) / 2.0;
            ASSERT_NEAR(drawn[k], exact, 4.0 * error[k]);
            ASSERT_NEAR(sum[k], exact, 0.03); // 256 × 128 midpoints, a step at the horizon
        }
    }
    ASSERT_NEAR(alpi_sky_mean(sky).x, 1.5, 1e-6);
    ASSERT_NEAR(alpi_sky_mean(sky).z, 2.0, 1e-6);
    sky_check_density(sky, 128);
    alpi_sky_destroy(context, sky);
    o.down[0] = o.down[2] = 0.0f; // black below
    sky = sky_make(context, &o, UP);
    sky_check_density(sky, 128);
    float density = 0.0f;
    vec3 d = alpi_sky_sample(sky, (vec2){0.0f, 0.5f}, &density);
    assert_true(density > 0.0f && d.y >= 0.0f);
    alpi_sky_destroy(context, sky);
}

TEST_WITH_CONTEXT(black_skies_are_none, 1)
{
    alp_image_info info = {8, 4, 3, ALP_COMPONENT_FLOAT};
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &image));
    for (int kind = ALP_SKY_NONE; kind <= ALP_SKY_CLEAR; kind++) {
        alp_sky_options o = sky_options((alp_sky_kind)kind);
        o.image = image;
        o.strength = kind == ALP_SKY_IMAGE ? 1.0f : 0.0f;
        alpi_sky *sky = (alpi_sky *)&o;
        ASSERT_OK(context, alpi_sky_create(context, &o, UP, &sky));
        assert_null(sky);
    }
    alpi_sky_destroy(context, NULL);
    alp_image_destroy(image);
}

/// Both ends of every number are taken, one step past them is refused by name.
TEST_WITH_CONTEXT(values_out_of_range_are_named, 1)
{
    const float past[] = {-1e-30f, 1.1e30f, INFINITY, NAN};
    for (int i = 0; i < 4; i++) {
        alp_sky_options o = sky_options(ALP_SKY_CONSTANT);
        o.up[2] = past[i];
        sky_refuse(context, &o, UP, "up[2]");
        o.kind = ALP_SKY_HEMISPHERE;
        sky_refuse(context, &o, UP, "up[2]");
        o = sky_options(ALP_SKY_HEMISPHERE);
        o.down[0] = past[i];
        sky_refuse(context, &o, UP, "down[0]");
        o = sky_options(ALP_SKY_CLEAR);
        o.strength = past[i];
        sky_refuse(context, &o, UP, "strength");
    }
    alp_sky_options o = sky_options(ALP_SKY_CONSTANT);
    const float ends[] = {1e-30f, 1e30f};
    for (int i = 0; i < 2; i++) {
        o.up[0] = ends[i];
        alpi_sky_destroy(context, sky_make(context, &o, UP));
    }
    o.strength = 1.01f;
    sky_refuse(context, &o, UP, "strength");
    o = sky_options(ALP_SKY_CONSTANT);
    o.strength = 1e30f;
    alpi_sky_destroy(context, sky_make(context, &o, UP));
    o.strength = 1.0f;
    o.turn = INFINITY;
    sky_refuse(context, &o, UP, "turn");
    o.turn = NAN;
    sky_refuse(context, &o, UP, "turn");
    o.turn = -3e38f;
    alpi_sky_destroy(context, sky_make(context, &o, UP));
    o = sky_options((alp_sky_kind)5);
    sky_refuse(context, &o, UP, "kind 5");
    o.kind = (alp_sky_kind)-1;
    sky_refuse(context, &o, UP, "kind -1");
}

TEST_WITH_CONTEXT(the_clear_sky_wants_a_sun_and_air, 1)
{
    alp_sky_options o = sky_options(ALP_SKY_CLEAR);
    const float good[] = {1.7f, 10.0f}, bad[] = {1.6999f, 10.001f, NAN, INFINITY, -3.0f};
    for (int i = 0; i < 2; i++) {
        o.turbidity = good[i];
        alpi_sky_destroy(context, sky_make(context, &o, UP));
    }
    for (int i = 0; i < 5; i++) {
        o.turbidity = bad[i];
        sky_refuse(context, &o, UP, "turbidity");
    }
    o.turbidity = 3.0f;
    const vec3 suns[] = {{0.0f, 0.0f, 0.0f}, {NAN, 1.0f, 0.0f}, {0.0f, 2.0f, 0.0f}};
    for (int i = 0; i < 3; i++) {
        sky_refuse(context, &o, suns[i], "sun's direction");
    }
    o.strength = 1e30f;
    sky_refuse(context, &o, UP, "lower it");
}
