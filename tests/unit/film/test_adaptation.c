// SPDX-License-Identifier: MIT
// Metering, and adaptation to what is metered over time.
#include "film_pictures.h"

#include "film/white_balance.h"

#include <math.h>

static double metered(alp_context *context, alp_image *image, const alp_film_options *options,
                      uint64_t *pixels)
{
    double luminance = (double)NAN;
    ASSERT_OK(context, alp_film_meter(image, options, &luminance, pixels));
    alp_image_destroy(image);
    return luminance;
}

TEST_WITH_CONTEXT(the_mean_is_of_logarithms, 1)
{
    alp_film_options options = alp_film_options_default();
    options.meter_low = 0.0f;
    options.meter_high = 1.0f;
    uint64_t pixels = 0;
    const float values[] = {0.5f, 2.0f, 8.0f, 0.0f, NAN, INFINITY, -1.0f};
    ASSERT_NEAR(metered(context, picture(context, 7, 1, 1, values), &options, &pixels), 1.0, 1e-12);
    assert_int_equal(pixels, 3); // what is not light does not count
    // Rec. 709: red, green and blue of strength 1 have .2126, .7152, .0722
    const float red[] = {1.0f, 0.0f, 0.0f}, blue[] = {0.0f, 0.0f, 1.0f};
    ASSERT_NEAR(metered(context, picture(context, 1, 1, 3, red), &options, NULL), log2(0.2126),
                5e-4);
    ASSERT_NEAR(metered(context, picture(context, 1, 1, 3, blue), &options, NULL), log2(0.0722),
                1e-3); // the digits given
    // alpha 0 does not count
    const float covered[] = {4.0f, 1.0f, 1024.0f, 0.0f, 4.0f, 0.5f};
    ASSERT_NEAR(metered(context, picture(context, 3, 1, 2, covered), &options, &pixels), 2.0,
                1e-12);
    assert_int_equal(pixels, 2);
}

TEST_WITH_CONTEXT(extremes_are_left_out, 1)
{
    float values[100];
    for (int i = 0; i < 100; i++) {
        values[i] = i < 5 ? 1e-9f : i < 95 ? 4.0f : 1e9f; // 5 % dark, 5 % bright
    }
    // ranks are of floats: .05f is 1e-9 off .05, which lets 1e-7 of a pixel in
    ASSERT_NEAR(metered(context, picture(context, 10, 10, 1, values), NULL, NULL), 2.0, 1e-6);
    // half a bin: of four pixels the middle two, cut where the shares cut
    const float four[] = {1.0f, 2.0f, 4.0f, 8.0f};
    alp_film_options options = alp_film_options_default();
    options.meter_low = 0.125f; // half of the first
    options.meter_high = 0.75f; // and three
    ASSERT_NEAR(metered(context, picture(context, 4, 1, 1, four), &options, NULL), 3.0 / 2.5,
                1e-12);
}

TEST_WITH_CONTEXT(metering_sees_what_is_balanced, 1)
{
    alp_film_options options = alp_film_options_default();
    options.white_balance = ALP_WHITE_BALANCE_KELVIN;
    options.kelvin = 3000.0f;
    const float color[] = {0.25f, 0.5f, 1.0f};
    double xy[2], weights[3], out[3] = {0.25, 0.5, 1.0};
    alpi_kelvin_chromaticity(3000.0, xy);
    const alpi_matrix3 balance = alpi_balance_for_chromaticity(xy);
    alpi_matrix3_apply(&balance, out, out);
    alpi_luminance_weights(weights);
    double luminance = out[0] * weights[0] + out[1] * weights[1] + out[2] * weights[2];
    ASSERT_NEAR(metered(context, picture(context, 1, 1, 3, color), &options, NULL), log2(luminance),
                1e-12);
    assert_true(fabs(log2(luminance / (0.2126 * 0.25 + 0.7152 * 0.5 + 0.0722))) > 0.01);
}

TEST_WITH_CONTEXT(one_pixel_has_a_mean, 1)
{
    const float value = 32.0f;
    ASSERT_NEAR(metered(context, picture(context, 1, 1, 1, &value), NULL, NULL), 5.0, 1e-12);
}

static void adapt(alp_film_adaptation *state, float light, double seconds, double *exposure)
{
    alp_context *context = test_context(1);
    alp_image *image = picture(context, 1, 1, 1, &light);
    ASSERT_OK(context, alp_film_adapt(state, image, NULL, seconds, exposure));
    alp_image_destroy(image);
    alp_context_destroy(context);
}

TEST(half_is_gone_after_a_half_life)
{
    alp_film_adaptation a = alp_film_adaptation_default();
    a.brighter_seconds = 0.5;
    a.darker_seconds = 3.0;
    double exposure = 0.0;
    adapt(&a, 1.0f, 0.0, &exposure); // the first picture is adapted to at once
    assert_true(a.adapted);
    ASSERT_NEAR(a.log2_luminance, 0.0, 1e-12);
    ASSERT_NEAR(exposure, log2(0.18), 1e-7); // the key is a float
    adapt(&a, 256.0f, 0.5 * log(2.0), &exposure);
    ASSERT_NEAR(a.log2_luminance, 4.0, 1e-12);
    ASSERT_NEAR(exposure, log2(0.18) - 4.0, 1e-7);
    adapt(&a, 256.0f, 0.5 * log(2.0), NULL);
    ASSERT_NEAR(a.log2_luminance, 6.0, 1e-12);
    adapt(&a, 0.25f, 3.0 * log(2.0), NULL); // towards the dark by its own constant
    ASSERT_NEAR(a.log2_luminance, 2.0, 1e-12);
    adapt(&a, 0.25f, 3.0, NULL);
    ASSERT_NEAR(a.log2_luminance, -2.0 + 4.0 * exp(-1.0), 1e-12);
}

TEST(steps_do_not_matter)
{
    const float lights[] = {100.0f, 0.01f};
    for (int i = 0; i < 2; i++) {
        alp_film_adaptation whole = alp_film_adaptation_default();
        adapt(&whole, 1.0f, 1.0, NULL);
        alp_film_adaptation fine = whole, uneven = whole;
        adapt(&whole, lights[i], 1.0, NULL);
        for (int step = 0; step < 100; step++) {
            adapt(&fine, lights[i], 0.01, NULL);
        }
        adapt(&uneven, lights[i], 0.125, NULL);
        adapt(&uneven, lights[i], 0.0, NULL);
        adapt(&uneven, lights[i], 0.875, NULL);
        ASSERT_NEAR(fine.log2_luminance, whole.log2_luminance, 1e-12); // rounding of 100 steps
        ASSERT_NEAR(uneven.log2_luminance, whole.log2_luminance, 1e-13);
    }
}

TEST(ends_of_time)
{
    alp_film_adaptation a = alp_film_adaptation_default();
    double exposure = 9.0;
    adapt(&a, 0.0f, 1.0, &exposure); // nothing to see: still nothing
    assert_false(a.adapted);
    assert_true(exposure == 0.0);
    adapt(&a, 4.0f, 1.0, NULL);
    adapt(&a, 0.0f, 5.0, &exposure); // black: stays
    ASSERT_NEAR(a.log2_luminance, 2.0, 1e-12);
    ASSERT_NEAR(exposure, log2(0.18) - 2.0, 1e-7);
    adapt(&a, 64.0f, 0.0, NULL);
    ASSERT_NEAR(a.log2_luminance, 2.0, 1e-12);
    adapt(&a, 64.0f, (double)INFINITY, NULL);
    ASSERT_NEAR(a.log2_luminance, 6.0, 1e-12);
    a.darker_seconds = 0.0;
    adapt(&a, 1.0f, 0.0, NULL);
    ASSERT_NEAR(a.log2_luminance, 6.0, 1e-12);
    adapt(&a, 1.0f, 1e-9, NULL);
    ASSERT_NEAR(a.log2_luminance, 0.0, 1e-12);
    a.brighter_seconds = (double)INFINITY;
    adapt(&a, 64.0f, 1e9, NULL);
    ASSERT_NEAR(a.log2_luminance, 0.0, 1e-12);
}

TEST_WITH_CONTEXT(bad_arguments_are_refused, 1)
{
    alp_image *image = picture(context, 1, 1, 1, NULL), *bytes = NULL;
    alp_image_info info = {1, 1, 1, ALP_COMPONENT_U8};
    ASSERT_OK(context, alp_image_create(context, info, &bytes));
    const alp_result refused = ALP_ERROR_INVALID_ARGUMENT;
    alp_film_adaptation good = alp_film_adaptation_default(), bad = good;
    double luminance = 7.0;
    assert_int_equal(alp_film_adapt(NULL, image, NULL, 1.0, NULL), refused);
    assert_int_equal(alp_film_adapt(&good, NULL, NULL, 1.0, NULL), refused);
    assert_int_equal(alp_film_adapt(&good, bytes, NULL, 1.0, NULL), refused);
    assert_int_equal(alp_film_adapt(&good, image, NULL, -1.0, NULL), refused);
    assert_int_equal(alp_film_adapt(&good, image, NULL, (double)NAN, NULL), refused);
    bad.struct_size = 0;
    assert_int_equal(alp_film_adapt(&bad, image, NULL, 1.0, NULL), refused);
    bad = good;
    bad.darker_seconds = -1.0;
    assert_int_equal(alp_film_adapt(&bad, image, NULL, 1.0, NULL), refused);
    bad = good;
    bad.adapted = true;
    bad.log2_luminance = (double)NAN;
    assert_int_equal(alp_film_adapt(&bad, image, NULL, 1.0, NULL), refused);
    assert_int_equal(alp_film_meter(image, NULL, NULL, NULL), refused);
    assert_int_equal(alp_film_meter(bytes, NULL, &luminance, NULL), refused);
    ASSERT_OK(context, alp_film_meter(image, NULL, &luminance, NULL)); // black
    assert_true(luminance == 7.0);
    alp_image_destroy(image);
    alp_image_destroy(bytes);
}
