// SPDX-License-Identifier: MIT
// Linear light to 8-bit sRGB.
#include "test_support.h"

#include <math.h>

static void show(const float *values, uint32_t width, uint32_t channels, uint8_t *bytes)
{
    alp_context *context = test_context(1);
    alp_image *linear = NULL, *display = NULL;
    alp_image_info info = {width, 1, channels, ALP_COMPONENT_FLOAT};
    ASSERT_OK(context, alp_image_create(context, info, &linear));
    memcpy(alp_image_floats(linear), values, sizeof(float) * width * channels);
    ASSERT_OK(context, alp_image_to_display(linear, &display));
    alp_image_info made = alp_image_get_info(display);
    assert_int_equal(made.channels, 3);
    assert_int_equal(made.component, ALP_COMPONENT_U8);
    assert_int_equal(made.width, width);
    memcpy(bytes, alp_image_bytes(display), (size_t)width * 3);
    alp_image_destroy(linear);
    alp_image_destroy(display);
    alp_context_destroy(context);
}

TEST(light_is_encoded_as_srgb)
{
    // IEC 61966-2-1: .18 → .4613, .21586 → 128/255, .0031308 → .04045, and the ends
    const float values[] = {0.0f, 0.18f, 0.21586f, 0.0031308f, 1.0f, 7.0f, -1.0f, NAN};
    const uint8_t expected[] = {0, 118, 128, 10, 255, 255, 0, 0};
    uint8_t bytes[24];
    show(values, 8, 1, bytes);
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 3; k++) {
            assert_int_equal(bytes[3 * i + k], expected[i]);
        }
    }
}

TEST(colors_keep_their_places)
{
    const float values[] = {1.0f, 0.21586f, 0.0f};
    uint8_t bytes[3];
    show(values, 1, 3, bytes);
    assert_int_equal(bytes[0], 255);
    assert_int_equal(bytes[1], 128);
    assert_int_equal(bytes[2], 0);
}

TEST(the_background_is_grey)
{
    const float values[] = {NAN, 9.0f, -1.0f, 0.0f, 1.0f, 0.5f, 0.5f, NAN, 1.0f, 1.0f, 1.0f, 0.5f};
    uint8_t bytes[9];
    show(values, 3, 4, bytes);
    assert_int_equal(bytes[0], 96);
    assert_int_equal(bytes[1], 96);
    assert_int_equal(bytes[2], 96);
    assert_int_equal(bytes[3], 96); // alpha that is not a number is none
    // Half white over grey 96 (linear .1170), mixed as light: .5585 → .7725 → 197
    assert_int_equal(bytes[6], 197);
}

TEST_WITH_CONTEXT(bytes_are_refused, 1)
{
    alp_image *image = NULL, *display = NULL;
    alp_image_info info = {2, 2, 3, ALP_COMPONENT_U8};
    ASSERT_OK(context, alp_image_create(context, info, &image));
    assert_int_equal(alp_image_to_display(image, &display), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_image_to_display(NULL, &display), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(display);
    alp_image_destroy(image);
}
