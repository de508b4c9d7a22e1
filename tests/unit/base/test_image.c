// SPDX-License-Identifier: MIT
// Images: limits, bilinear look-up with its wraps, the sRGB curve.
#include "test_support.h"

#include "base/image.h"

#include <math.h>

static alp_image *new_image(alp_context *context, uint32_t width, uint32_t height,
                            uint32_t channels, alp_component component)
{
    alp_image *image = NULL;
    const alp_image_info info = {width, height, channels, component};
    ASSERT_OK(context, alp_image_create(context, info, &image));
    return image;
}

TEST_WITH_CONTEXT(limits_are_kept, 1)
{
    const alp_image_info bad[] = {
        {0, 1, 1, ALP_COMPONENT_U8},     {1, 0, 1, ALP_COMPONENT_U8},
        {65537, 1, 1, ALP_COMPONENT_U8}, {1, 65537, 1, ALP_COMPONENT_U8},
        {1, 1, 0, ALP_COMPONENT_U8},     {1, 1, 5, ALP_COMPONENT_U8},
        {1, 1, 1, (alp_component)2},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        alp_image *image = (alp_image *)context;
        assert_int_equal(alp_image_create(context, bad[i], &image), ALP_ERROR_INVALID_ARGUMENT);
        assert_null(image);
    }
    alp_image *image = new_image(context, 65536, 1, 1, ALP_COMPONENT_U8);
    assert_non_null(alp_image_bytes(image));
    assert_null(alp_image_floats(image));
    assert_int_equal(alp_image_bytes(image)[65535], 0);
    alp_image_destroy(image);
    alp_image_destroy(NULL);
    assert_null(alp_image_bytes(NULL));
    assert_int_equal(alp_image_get_info(NULL).width, 0);
}

TEST_WITH_CONTEXT(missing_channels_are_filled, 1)
{
    const float expected[4][4] = {{0.2f, 0.2f, 0.2f, 1.0f},
                                  {0.2f, 0.2f, 0.2f, 0.4f},
                                  {0.2f, 0.4f, 0.6f, 1.0f},
                                  {0.2f, 0.4f, 0.6f, 0.8f}};
    for (uint32_t channels = 1; channels <= 4; channels++) {
        alp_image *image = new_image(context, 1, 1, channels, ALP_COMPONENT_U8);
        for (uint32_t k = 0; k < channels; k++) {
            alp_image_bytes(image)[k] = (uint8_t)(51 * (k + 1));
        }
        float rgba[4];
        alpi_image_pixel(image, 0, 0, rgba);
        for (int k = 0; k < 4; k++) {
            ASSERT_NEAR(rgba[k], expected[channels - 1][k], 1e-7);
        }
        alp_image_destroy(image);
    }
}

/// 4 × 2 grey floats: 0 1 2 3 / 10 11 12 13.
static alp_image *ramp(alp_context *context)
{
    alp_image *image = new_image(context, 4, 2, 1, ALP_COMPONENT_FLOAT);
    for (int i = 0; i < 8; i++) {
        alp_image_floats(image)[i] = (float)(i % 4 + 10 * (i / 4));
    }
    return image;
}

static float at(const alp_image *image, double u, double v, alpi_wrap wrap)
{
    float rgba[4];
    alpi_image_sample(image, (float)u, (float)v, (alpi_sampler){wrap, wrap, false}, rgba);
    return rgba[0];
}

TEST_WITH_CONTEXT(texel_centres_give_texels, 1)
{
    alp_image *image = ramp(context);
    for (int wrap = ALPI_WRAP_REPEAT; wrap <= ALPI_WRAP_MIRROR; wrap++) {
        for (int i = 0; i < 8; i++) {
            double u = (i % 4 + 0.5) / 4.0, v = (i / 4 + 0.5) / 2.0;
            ASSERT_NEAR(at(image, u, v, (alpi_wrap)wrap), i % 4 + 10 * (i / 4), 0.0);
        }
        ASSERT_NEAR(at(image, 0.5, 0.5, (alpi_wrap)wrap), 6.5, 0.0); // between four
    }
    alp_image_destroy(image);
}

TEST_WITH_CONTEXT(coordinates_outside_wrap, 1)
{
    alp_image *image = ramp(context);
    // Half a texel outside the left border, on the first row: repeat mixes 3 and 0.
    ASSERT_NEAR(at(image, 0.0, 0.25, ALPI_WRAP_REPEAT), 1.5, 0.0);
    ASSERT_NEAR(at(image, 0.0, 0.25, ALPI_WRAP_CLAMP), 0.0, 0.0);
    ASSERT_NEAR(at(image, 0.0, 0.25, ALPI_WRAP_MIRROR), 0.0, 0.0);
    // Texel 5, that is one and a half texels right of the last.
    ASSERT_NEAR(at(image, 5.5 / 4.0, 0.25, ALPI_WRAP_REPEAT), 1.0, 0.0);
    ASSERT_NEAR(at(image, 5.5 / 4.0, 0.25, ALPI_WRAP_CLAMP), 3.0, 0.0);
    ASSERT_NEAR(at(image, 5.5 / 4.0, 0.25, ALPI_WRAP_MIRROR), 2.0, 0.0);
    // Negative, several periods away: texel -10.
    ASSERT_NEAR(at(image, -9.5 / 4.0, 0.25, ALPI_WRAP_REPEAT), 2.0, 0.0);
    ASSERT_NEAR(at(image, -9.5 / 4.0, 0.25, ALPI_WRAP_MIRROR), 1.0, 0.0);
    alp_image_destroy(image);
}

TEST_WITH_CONTEXT(senseless_coordinates_read_as_zero, 1)
{
    alp_image *image = ramp(context);
    const double odd[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 1e30, -1e30};
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        for (int wrap = ALPI_WRAP_REPEAT; wrap <= ALPI_WRAP_MIRROR; wrap++) {
            ASSERT_NEAR(at(image, odd[i], 0.25, (alpi_wrap)wrap),
                        at(image, 0.0, 0.25, (alpi_wrap)wrap), 0.0);
            ASSERT_NEAR(at(image, 0.125, odd[i], (alpi_wrap)wrap),
                        at(image, 0.125, 0.0, (alpi_wrap)wrap), 0.0);
        }
    }
    assert_true(isfinite(at(image, 1e9, -1e9, ALPI_WRAP_REPEAT)));
    alp_image_destroy(image);
}

TEST(the_srgb_curve_goes_there_and_back)
{
    for (int i = 0; i < 256; i++) {
        float encoded = (float)i / 255.0f;
        ASSERT_NEAR(alpi_linear_to_srgb(alpi_srgb_to_linear(encoded)) * 255.0f, i, 1e-3);
    }
    // IEC 61966-2-1 at a few places, by hand.
    ASSERT_NEAR(alpi_srgb_to_linear(0.5f), 0.21404114, 1e-7);
    ASSERT_NEAR(alpi_srgb_to_linear(0.04f), 0.04 / 12.92, 1e-9);
    ASSERT_NEAR(alpi_linear_to_srgb(0.5f), 0.73535698, 1e-6);
    ASSERT_NEAR(alpi_linear_to_srgb(0.001f), 0.01292, 1e-8);
    ASSERT_NEAR(alpi_linear_to_srgb(-1.0f), 0.0, 0.0);
    ASSERT_NEAR(alpi_linear_to_srgb(7.0f), 1.0, 1e-6);
    ASSERT_NEAR(alpi_linear_to_srgb(NAN), 0.0, 0.0);
}

TEST(srgb_is_decoded_before_the_mean)
{
    // Half way between a black and a white texel: light .5, where decoding the mean gives .214.
    alp_context *context = test_context(1);
    alp_image *image = NULL;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){2, 1, 4, ALP_COMPONENT_U8}, &image));
    const uint8_t pixels[8] = {0, 0, 0, 0, 255, 255, 255, 255};
    memcpy(alp_image_bytes(image), pixels, sizeof pixels);
    float rgba[4];
    alpi_image_sample(image, 0.5f, 0.5f, (alpi_sampler){ALPI_WRAP_CLAMP, ALPI_WRAP_CLAMP, true},
                      rgba);
    ASSERT_NEAR(rgba[0], 0.5, 1e-6);
    ASSERT_NEAR(rgba[3], 0.5, 1e-6); // alpha is not encoded
    const uint8_t grey[8] = {128, 128, 128, 128, 128, 128, 128, 128};
    memcpy(alp_image_bytes(image), grey, sizeof grey);
    alpi_image_sample(image, 0.5f, 0.5f, (alpi_sampler){ALPI_WRAP_CLAMP, ALPI_WRAP_CLAMP, true},
                      rgba);
    ASSERT_NEAR(rgba[1], 0.215861, 1e-5);
    ASSERT_NEAR(rgba[3], 128.0 / 255.0, 1e-6);
    alp_image_destroy(image);
    alp_context_destroy(context);
}
