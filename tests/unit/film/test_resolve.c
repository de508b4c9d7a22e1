// SPDX-License-Identifier: MIT
// Numbers of a development: with them, a host's own loop gives the same bytes.
#include "film_pictures.h"

#include "base/image.h"
#include "film/curves.h"

#include <math.h>

enum { WIDTH = 31, HEIGHT = 17 };

/// A byte of a pixel by the formula of alp_film_numbers.
static uint8_t byte_by_numbers(const alp_film_numbers *n, alp_tone tone, const float *rgba, int k)
{
    double balanced = 0.0;
    for (int i = 0; i < 3; i++) {
        balanced += n->balance[k][i] * (double)rgba[i];
    }
    const double value = fmin(alpi_film_curve(tone, n->white, n->gain * balanced), 1.0);
    return (uint8_t)((double)(alpi_linear_to_srgb((float)value) * 255.0f) + 0.5);
}

static void check_numbers(alp_context *context, const alp_film_options *options)
{
    alp_image *linear = lively_picture(context, WIDTH, HEIGHT, 3.0f);
    const uint32_t channels = alp_image_get_info(linear).channels;
    alp_film_numbers numbers;
    double exposure = -99.0;
    ASSERT_OK(context, alp_film_resolve(linear, options, &numbers));
    alp_image *display = NULL;
    ASSERT_OK(context, alp_film_develop(linear, options, &display, &exposure));
    assert_true(numbers.exposure == exposure);
    assert_true(numbers.gain == exp2(exposure));
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        for (int k = 0; k < 3; k++) {
            assert_int_equal(alp_image_bytes(display)[3 * i + (size_t)k],
                             byte_by_numbers(&numbers, options->tone,
                                             alp_image_floats(linear) + channels * i, k));
        }
    }
    alp_image_destroy(display);
    alp_image_destroy(linear);
}

TEST_WITH_CONTEXT(numbers_develop_as_the_library_does, 1)
{
    for (int tone = ALP_TONE_FILM; tone <= ALP_TONE_NONE; tone++) {
        for (int balance = ALP_WHITE_BALANCE_OFF; balance <= ALP_WHITE_BALANCE_AUTO; balance++) {
            alp_film_options options = alp_film_options_default();
            options.tone = (alp_tone)tone;
            options.white_balance = (alp_white_balance)balance;
            options.kelvin = 3000.0f;
            options.auto_exposure = tone % 2 == 0;
            options.exposure = options.auto_exposure ? 0.0 : -0.7;
            check_numbers(context, &options);
        }
    }
}

TEST_WITH_CONTEXT(numbers_need_a_picture_and_a_place, 1)
{
    alp_image *linear = lively_picture(context, WIDTH, HEIGHT, 3.0f);
    alp_film_numbers numbers;
    alp_film_options wrong = alp_film_options_default();
    wrong.key = 0.0f;
    assert_int_equal(alp_film_resolve(NULL, NULL, &numbers), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_film_resolve(linear, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_film_resolve(linear, &wrong, &numbers), ALP_ERROR_INVALID_ARGUMENT);
    ASSERT_OK(context, alp_film_resolve(linear, NULL, &numbers));
    assert_true(numbers.gain == 1.0 && numbers.balance[0][0] == 1.0 &&
                numbers.balance[0][1] == 0.0);
    alp_image_destroy(linear);
}
