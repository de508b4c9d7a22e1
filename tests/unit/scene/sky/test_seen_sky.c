// SPDX-License-Identifier: MIT
// The sky by direction, as hosts draw it.
#include "test_support.h"

#include "scene/lights/lighting_options.h"
#include "scene/sky/sky.h"

#include <math.h>

static const float up[3] = {0, 1, 0}, down[3] = {0, -1, 0};

TEST_WITH_CONTEXT(two_colours_lie_above_and_below, 1)
{
    alp_lighting_options o = alp_lighting_options_default();
    float directions[2][3], radiance[2][3];
    memcpy(directions[0], up, sizeof up);
    memcpy(directions[1], down, sizeof down);
    o.sky.kind = ALP_SKY_HEMISPHERE;
    o.sky.up[1] = 0.25f;
    o.sky.down[2] = 0.5f;
    o.sky.strength = 2.0f;
    ASSERT_OK(context, alp_sky_radiance(context, &o, 2, (const float(*)[3])directions, radiance));
    assert_true(radiance[0][0] == 2.0f && radiance[0][1] == 0.5f && radiance[0][2] == 2.0f);
    assert_true(radiance[1][0] == 0.0f && radiance[1][1] == 0.0f && radiance[1][2] == 1.0f);
}

TEST_WITH_CONTEXT(without_a_sky_all_is_black, 1)
{
    const alp_lighting_options o = alp_lighting_options_default();
    float radiance[1][3] = {{9, 9, 9}};
    ASSERT_OK(context, alp_sky_radiance(context, &o, 1, &up, radiance));
    assert_true(radiance[0][0] == 0.0f && radiance[0][1] == 0.0f && radiance[0][2] == 0.0f);
    ASSERT_OK(context, alp_sky_radiance(context, &o, 0, NULL, NULL));
}

TEST_WITH_CONTEXT(clear_skies_leave_out_the_disk, 1)
{
    alp_lighting_options o = alp_lighting_options_default();
    alpi_sky *sky = NULL;
    float toward[1][3], radiance[1][3];
    o.sky.kind = ALP_SKY_CLEAR;
    o.sun.elevation = 0.6f;
    o.sun.illuminance = 80000.0f;
    const vec3 sun = alpi_sun_direction(&o.sun);
    vec3_store(toward[0], sun);
    ASSERT_OK(context, alp_sky_radiance(context, &o, 1, (const float(*)[3])toward, radiance));
    ASSERT_OK(context, alpi_sky_create(context, &o.sky, sun, &sky));
    ASSERT_NEAR(radiance[0][1], alpi_sky_radiance(sky, sun).y, 0.0);
    // The disk would be 80000 / (pi sin^2 of half of .53 degrees) = 1.2e9.
    assert_true(radiance[0][1] > 1e3f && radiance[0][1] < 1e6f);
    alpi_sky_destroy(context, sky);
}

TEST_WITH_CONTEXT(faults_of_skies_are_told, 1)
{
    alp_lighting_options o = alp_lighting_options_default();
    float radiance[1][3];
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    assert_int_equal(alp_sky_radiance(NULL, &o, 1, &up, radiance), code);
    assert_int_equal(alp_sky_radiance(context, NULL, 1, &up, radiance), code);
    assert_int_equal(alp_sky_radiance(context, &o, 1, NULL, radiance), code);
    assert_int_equal(alp_sky_radiance(context, &o, 1, &up, NULL), code);
    o.sky.kind = ALP_SKY_IMAGE; // without an image
    assert_int_equal(alp_sky_radiance(context, &o, 1, &up, radiance), code);
    o.sky.kind = ALP_SKY_CONSTANT;
    o.sky.up[0] = -1.0f;
    assert_int_equal(alp_sky_radiance(context, &o, 1, &up, radiance), code);
    o.sky.up[0] = 1.0f;
    o.struct_size = 0;
    assert_int_equal(alp_sky_radiance(context, &o, 1, &up, radiance), code);
}
