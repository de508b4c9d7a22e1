// SPDX-License-Identifier: MIT
// Developing: exposure, automatic exposure, dithering, and numbers that are none.
#include "film_pictures.h"

#include <math.h>

TEST_WITH_CONTEXT(one_stop_doubles, 1)
{
    for (int tone = ALP_TONE_FILM; tone <= ALP_TONE_NONE; tone++) {
        alp_film_options options = alp_film_options_default();
        options.tone = (alp_tone)tone;
        double used = 9.0;
        uint8_t *doubled =
            developed(context, lively_picture(context, 31, 17, 2.0f), &options, &used);
        assert_true(used == 0.0);
        options.exposure = 1.0;
        uint8_t *exposed =
            developed(context, lively_picture(context, 31, 17, 1.0f), &options, &used);
        assert_true(used == 1.0);
        assert_memory_equal(doubled, exposed, 31 * 17 * 3); // a factor of two is exact
        free(doubled);
        free(exposed);
    }
}

TEST_WITH_CONTEXT(radiance_one_is_the_exposure, 1)
{
    const float one = 1.0f;
    alp_film_options options = alp_film_options_default();
    options.tone = ALP_TONE_FILM;
    // 1 − e^−1 = .63212 → .81648 · 255 = 208.2; k = 2^−2: 1 − e^−.25 = .22120 → .50780 · 255 =
    // 129.5 (129.49, so 129)
    uint8_t *bytes = developed(context, picture(context, 1, 1, 1, &one), &options, NULL);
    assert_int_equal(bytes[0], 208);
    free(bytes);
    options.exposure = -2.0;
    bytes = developed(context, picture(context, 1, 1, 1, &one), &options, NULL);
    double encoded = 255.0 * (1.055 * pow(1.0 - exp(-0.25), 1.0 / 2.4) - 0.055);
    assert_int_equal(bytes[0], (int)(encoded + 0.5));
    free(bytes);
}

static alp_film_options automatic(void)
{
    alp_film_options options = alp_film_options_default();
    options.auto_exposure = true;
    options.tone = ALP_TONE_FILM;
    return options;
}

TEST_WITH_CONTEXT(automatic_exposure_forgets_the_scale, 1)
{
    alp_film_options options = automatic();
    const alp_white_balance balances[] = {ALP_WHITE_BALANCE_OFF, ALP_WHITE_BALANCE_AUTO};
    for (int i = 0; i < 2; i++) {
        options.white_balance = balances[i];
        double first = 0.0, eighth = 0.0;
        uint8_t *a = developed(context, lively_picture(context, 64, 48, 1.0f), &options, &first);
        uint8_t *b = developed(context, lively_picture(context, 64, 48, 8.0f), &options, &eighth);
        ASSERT_NEAR(first - eighth, 3.0, 1e-12); // rounding of hundredths
        assert_memory_equal(a, b, 64 * 48 * 3);
        // it is a whole number of hundredths, so that two printed digits say all
        assert_true(first == round(first * 100.0) / 100.0);
        // what was used gives the same picture when it is asked for
        options.auto_exposure = false;
        options.exposure = first;
        uint8_t *c = developed(context, lively_picture(context, 64, 48, 1.0f), &options, NULL);
        assert_memory_equal(a, c, 64 * 48 * 3);
        options.auto_exposure = true;
        free(a);
        free(b);
        free(c);
    }
}

TEST_WITH_CONTEXT(grey_becomes_the_key, 1)
{
    const float values[] = {3.0f, 3.0f, 3.0f, 3.0f};
    alp_film_options options = automatic();
    options.tone = ALP_TONE_NONE;
    double used = 0.0;
    uint8_t *bytes = developed(context, picture(context, 2, 2, 1, values), &options, &used);
    ASSERT_NEAR(used, log2(0.18 / 3.0), 0.00501); // hundredths
    assert_int_equal(bytes[0], 118);              // .18 encoded
    free(bytes);
}

TEST_WITH_CONTEXT(nothing_to_meter_is_exposed_by_zero, 1)
{
    alp_film_options options = automatic();
    options.white_balance = ALP_WHITE_BALANCE_AUTO;
    const float values[] = {NAN, INFINITY, -1.0f, 0.0f, 0.0f, 0.0f};
    double used = 9.0;
    uint8_t *bytes = developed(context, picture(context, 6, 1, 1, values), &options, &used);
    assert_true(used == 0.0 && !signbit(used));
    const int expected[] = {0, 255, 0, 0, 0, 0};
    for (int i = 0; i < 18; i++) {
        assert_int_equal(bytes[i], expected[i / 3]);
    }
    free(bytes);
}

TEST_WITH_CONTEXT(numbers_that_are_none_are_shown, 1)
{
    // alpha last: NaN is black, +∞ is white, −∞ is black
    const float values[] = {NAN,       0.5f,  0.5f, 1.0f, INFINITY, INFINITY, INFINITY, 1.0f,
                            INFINITY,  0.0f,  NAN,  1.0f, 3e38f,    3e38f,    3e38f,    1.0f,
                            -INFINITY, -0.0f, 0.0f, 1.0f, 0.2f,     0.3f,     0.4f,     NAN};
    for (int tone = ALP_TONE_FILM; tone <= ALP_TONE_NONE; tone++) {
        for (int balance = 0; balance < 3; balance++) {
            for (int dither = 0; dither < 3; dither++) {
                alp_film_options o = alp_film_options_default();
                o.tone = (alp_tone)tone;
                o.white_balance = (alp_white_balance)balance;
                o.kelvin = 3000.0f;
                o.dither = (alp_dither)dither;
                o.auto_exposure = dither == 1;
                double used = (double)NAN;
                uint8_t *b = developed(context, picture(context, 6, 1, 4, values), &o, &used);
                assert_true(isfinite(used));
                for (int k = 0; k < 3; k++) {
                    assert_int_equal(b[3 + k], 255);
                    assert_int_equal(b[12 + k], 0);
                    assert_int_equal(b[15 + k], 96); // alpha that is no number shows nothing
                }
                if (balance == ALP_WHITE_BALANCE_OFF) {
                    assert_int_equal(b[0], 0);
                    assert_int_equal(b[6], 255);
                    assert_int_equal(b[7], 0);
                }
                free(b);
            }
        }
    }
}

/// Linear light whose encoded value is `byte` of 255, on the straight part of the curve.
static float linear_of_byte(double byte)
{
    return (float)(byte / 255.0 / 12.92);
}

TEST_WITH_CONTEXT(dithering_keeps_the_mean, 1)
{
    enum { SIDE = 512 };
    const double wanted[] = {0.5, 0.0, 3.25, 7.9};
    for (int i = 0; i < 4; i++) {
        for (int dither = ALP_DITHER_ORDERED; dither <= ALP_DITHER_HASHED; dither++) {
            alp_image *flat = picture(context, SIDE, SIDE, 1, NULL);
            for (size_t p = 0; p < (size_t)SIDE * SIDE; p++) {
                alp_image_floats(flat)[p] = linear_of_byte(wanted[i]);
            }
            alp_film_options options = alp_film_options_default();
            options.dither = (alp_dither)dither;
            uint8_t *bytes = developed(context, flat, &options, NULL);
            double sum = 0.0;
            for (size_t p = 0; p < (size_t)SIDE * SIDE; p++) {
                assert_int_equal(bytes[3 * p], bytes[3 * p + 1]);
                assert_int_equal(bytes[3 * p], bytes[3 * p + 2]);
                assert_true(fabs(bytes[3 * p] - wanted[i]) < 1.0);
                sum += bytes[3 * p];
            }
            // Ordered: thresholds stand 1/64 apart. Hashed: four standard errors of a coin.
            double fraction = wanted[i] - floor(wanted[i]);
            double error = dither == ALP_DITHER_ORDERED
                               ? 0.5 / 64.0 + 1e-6
                               : 4.0 * sqrt(fraction * (1.0 - fraction)) / SIDE + 1e-6;
            ASSERT_NEAR(sum / SIDE / SIDE, wanted[i], error);
            free(bytes);
        }
    }
}

TEST_WITH_CONTEXT(ordered_thresholds_are_all_different, 1)
{
    alp_film_options options = alp_film_options_default();
    options.dither = ALP_DITHER_ORDERED;
    for (int level = 0; level < 64; level++) { // light just above `level` of 64 thresholds
        alp_image *flat = picture(context, 8, 8, 1, NULL);
        for (int p = 0; p < 64; p++) {
            alp_image_floats(flat)[p] = linear_of_byte((level + 1.0) / 64.0);
        }
        uint8_t *bytes = developed(context, flat, &options, NULL);
        int white = 0;
        for (int p = 0; p < 64; p++) {
            white += bytes[3 * p];
        }
        assert_int_equal(white, level + 1);
        free(bytes);
    }
}

TEST_WITH_CONTEXT(the_ends_and_the_background_stay, 1)
{
    enum { SIDE = 256 };
    for (int dither = ALP_DITHER_NONE; dither <= ALP_DITHER_HASHED; dither++) {
        alp_image *image = picture(context, SIDE, SIDE, 2, NULL);
        float *values = alp_image_floats(image);
        for (size_t p = 0; p < (size_t)SIDE * SIDE; p++) {
            values[2 * p] = p % 3 == 1 ? 1.0f : 0.0f;
            values[2 * p + 1] = p % 3 == 2 ? 0.0f : 1.0f;
        }
        alp_film_options options = alp_film_options_default();
        options.dither = (alp_dither)dither;
        uint8_t *bytes = developed(context, image, &options, NULL);
        const int expected[] = {0, 255, 96};
        for (size_t p = 0; p < (size_t)SIDE * SIDE; p++) {
            assert_int_equal(bytes[3 * p], expected[p % 3]);
        }
        free(bytes);
    }
}

TEST_WITH_CONTEXT(the_default_is_the_display, 1)
{
    alp_image *image = lively_picture(context, 40, 30, 1.0f), *display = NULL;
    ASSERT_OK(context, alp_image_to_display(image, &display));
    const alp_film_options options = alp_film_options_default();
    uint8_t *bytes = developed(context, image, &options, NULL);
    assert_memory_equal(bytes, alp_image_bytes(display), 40 * 30 * 3);
    // and is what sRGB says, of values that are not on an edge
    alp_image *again = lively_picture(context, 40, 30, 1.0f);
    for (size_t i = 0; i < 40 * 30 * 3; i++) {
        double value = fmin((double)alp_image_floats(again)[i], 1.0);
        double encoded = value <= 0.0031308 ? 12.92 * value : 1.055 * pow(value, 1.0 / 2.4) - 0.055;
        assert_true(fabs(bytes[i] - 255.0 * encoded) <= 0.5001); // rounding of floats
    }
    alp_image_destroy(again);
    alp_image_destroy(display);
    free(bytes);
}

static void refuse(alp_context *context, const alp_film_options *options, const char *word)
{
    alp_image *image = picture(context, 1, 1, 3, NULL), *display = image;
    assert_int_equal(alp_film_develop(image, options, &display, NULL), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(display);
    assert_non_null(strstr(alp_context_message(context), word));
    alp_image_destroy(image);
}

TEST_WITH_CONTEXT(bad_options_are_refused, 1)
{
    const alp_film_options good = alp_film_options_default();
#define REFUSE(word, ...)                                                                          \
    do {                                                                                           \
        alp_film_options o = good;                                                                 \
        __VA_ARGS__;                                                                               \
        refuse(context, &o, word);                                                                 \
    } while (0)
    REFUSE("_default()", o.struct_size = 0);
    REFUSE("exposure", o.exposure = 64.1);
    REFUSE("exposure", o.exposure = -64.1);
    REFUSE("exposure", o.exposure = (double)NAN);
    REFUSE("key", o.key = 0.0f);
    REFUSE("key", o.key = 1.1f);
    REFUSE("meter", o.meter_low = 0.95f);
    REFUSE("meter", o.meter_low = -0.1f);
    REFUSE("meter", o.meter_high = 1.1f);
    REFUSE("tone", o.tone = (alp_tone)4);
    REFUSE("white_point", o.white_point = -1.0f);
    REFUSE("white_point", o.white_point = NAN);
    REFUSE("balance", o.white_balance = (alp_white_balance)3);
    REFUSE("kelvin", o.kelvin = 999.0f);
    REFUSE("kelvin", o.kelvin = 25001.0f);
    REFUSE("dither", o.dither = (alp_dither)3);
#undef REFUSE
    alp_image *image = picture(context, 1, 1, 3, NULL);
    assert_int_equal(alp_film_develop(image, &good, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    alp_image_destroy(image);
}

TEST(failed_allocations_are_told)
{
    int left = 1000;
    alp_context *context = test_context_failing(&left);
    alp_image *image = lively_picture(context, 8, 8, 1.0f), *display = NULL;
    alp_film_options options = automatic();
    options.white_balance = ALP_WHITE_BALANCE_AUTO;
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int needed = 0;
    for (; result != ALP_OK; needed++) {
        left = needed;
        result = alp_film_develop(image, &options, &display, NULL);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_true((result == ALP_OK) == (display != NULL));
    }
    assert_int_equal(needed - 1, 4); // two meters, the image and its pixels
    alp_image_destroy(display);
    alp_image_destroy(image);
    alp_context_destroy(context);
}
