// SPDX-License-Identifier: MIT
// What tests of film share: small pictures from numbers, and their bytes once developed.
#ifndef FILM_PICTURES_H
#define FILM_PICTURES_H

#include "test_support.h"

#include <math.h>
#include <stdlib.h>

/// A float image of these values, or of zeros (NULL).
static inline alp_image *picture(alp_context *context, uint32_t width, uint32_t height,
                                 uint32_t channels, const float *values)
{
    alp_image *image = NULL;
    alp_image_info info = {width, height, channels, ALP_COMPONENT_FLOAT};
    ASSERT_OK(context, alp_image_create(context, info, &image));
    if (values != NULL) {
        memcpy(alp_image_floats(image), values, sizeof(float) * width * height * channels);
    }
    return image;
}

/// Light of every strength from 2^-8 to 2^8 in all colours, different at each pixel.
static inline alp_image *lively_picture(alp_context *context, uint32_t width, uint32_t height,
                                        float strength)
{
    alp_image *image = picture(context, width, height, 3, NULL);
    float *values = alp_image_floats(image);
    uint32_t state = 1;
    for (size_t i = 0; i < (size_t)width * height * 3; i++) {
        state = state * 1664525u + 1013904223u; // Numerical Recipes' generator
        values[i] = strength * exp2f((float)(state >> 8) * 0x1p-20f - 8.0f);
    }
    return image;
}

/// Develops, destroys `linear`, and gives the bytes, which the caller frees.
static inline uint8_t *developed(alp_context *context, alp_image *linear,
                                 const alp_film_options *options, double *exposure)
{
    alp_image *display = NULL;
    ASSERT_OK(context, alp_film_develop(linear, options, &display, exposure));
    alp_image_info info = alp_image_get_info(display), from = alp_image_get_info(linear);
    assert_int_equal(info.width, from.width);
    assert_int_equal(info.height, from.height);
    assert_int_equal(info.channels, 3);
    size_t size = (size_t)info.width * info.height * 3;
    uint8_t *bytes = malloc(size);
    assert_non_null(bytes);
    memcpy(bytes, alp_image_bytes(display), size);
    alp_image_destroy(display);
    alp_image_destroy(linear);
    return bytes;
}

#endif
