// SPDX-License-Identifier: MIT
// Developing: linear light to an 8-bit picture, pixel by pixel.
#include "base/image.h"
#include "base/random.h"
#include "film/curves.h"
#include "film/meter.h"

#include <alpenglow/shared_constants.h>

#include <math.h>

/// Neither black nor white, so that both stand out from it.
static const uint8_t BACKGROUND = (uint8_t)ALP_FILM_BACKGROUND;

/// What infinite light counts as: more than any screen shows, at any exposure, and still a number
/// after a matrix.
static const double INFINITE_LIGHT = 1e60;

typedef struct development {
    alp_film_options options;
    alpi_matrix3 balance;
    bool balanced;
    double gain; // 2^exposure
    double white;
} development;

/// Linear light to values in [0, 1].
static void expose(const development *d, const float rgba[4], double values[3])
{
    for (int k = 0; k < 3; k++) {
        // Finite negative parts are colours beyond Rec. 709, which a white balance may bring in.
        double light = rgba[k] > -INFINITY ? (double)rgba[k] : 0.0;
        values[k] = fmin(light, INFINITE_LIGHT);
    }
    if (d->balanced) {
        alpi_matrix3_apply(&d->balance, values, values);
    }
    for (int k = 0; k < 3; k++) {
        double value = alpi_film_curve(d->options.tone, d->white, d->gain * values[k]);
        values[k] = fmin(value, 1.0);
    }
}

/// Rank of a pixel in Bayer's 8 × 8 pattern, at the middle of its 64th of [0, 1).
/// B. E. Bayer. An optimum method for two-level rendition of continuous-tone pictures. ICC 1973.
static double ordered_threshold(uint32_t x, uint32_t y)
{
    uint32_t rank = 0;
    for (uint32_t bit = 0; bit < 3; bit++) {
        rank |= (((x ^ y) >> bit) & 1u) << (5 - 2 * bit);
        rank |= ((y >> bit) & 1u) << (4 - 2 * bit);
    }
    return (rank + 0.5) / 64.0;
}

/// What is added before the fraction is cut off, [0, 1).
static double threshold(alp_dither dither, uint32_t x, uint32_t y)
{
    if (dither == ALP_DITHER_ORDERED) {
        return ordered_threshold(x, y);
    }
    if (dither == ALP_DITHER_HASHED) {
        return alpi_random_key(0, (uint64_t)y << 32 | x, 0) * 0x1p-32;
    }
    return 0.5;
}

/// Grey over grey: light is mixed linearly, so that an edge has no dark or bright rim.
static void develop_pixel(const development *d, const float rgba[4], double add, uint8_t pixel[3])
{
    if (!(rgba[3] > 0.0f)) { // what is under alpha 0, or under no number, is not looked at
        pixel[0] = pixel[1] = pixel[2] = BACKGROUND;
        return;
    }
    const float alpha = fminf(rgba[3], 1.0f);
    const float background = alpi_srgb_to_linear((float)BACKGROUND / 255.0f);
    double values[3];
    expose(d, rgba, values);
    for (int k = 0; k < 3; k++) {
        float mixed = alpha * (float)values[k] + (1.0f - alpha) * background;
        // in double: 255 and a threshold just below 1 must stay below 256
        pixel[k] = (uint8_t)((double)(alpi_linear_to_srgb(mixed) * 255.0f) + add);
    }
}

static void develop_pixels(const development *d, const alp_image *linear, uint8_t *pixel)
{
    for (uint32_t y = 0; y < linear->info.height; y++) {
        for (uint32_t x = 0; x < linear->info.width; x++, pixel += 3) {
            float rgba[4];
            alpi_image_pixel(linear, x, y, rgba);
            develop_pixel(d, rgba, threshold(d->options.dither, x, y), pixel);
        }
    }
}

/// Finds what the options leave to the picture.
static alp_result prepare(development *d, const alp_image *linear)
{
    alp_film_options *o = &d->options;
    ALP_TRY(alpi_film_balance(linear, o, &d->balance, &d->balanced));
    if (o->auto_exposure) {
        alpi_meter meter;
        ALP_TRY(alpi_meter_image(linear, o, d->balanced ? &d->balance : NULL, &meter));
        double exposure = meter.pixels > 0 ? alpi_film_exposure(o, meter.log2_luminance) : 0.0;
        o->exposure = round(exposure * 100.0) / 100.0 + 0.0; // never −0
    }
    d->gain = exp2(o->exposure);
    d->white = o->white_point > 0.0f ? (double)o->white_point : alpi_film_default_white(o->tone);
    return ALP_OK;
}

alp_result alp_film_resolve(const alp_image *linear, const alp_film_options *options,
                            alp_film_numbers *numbers)
{
    ALP_TRY(alpi_film_check(linear, options));
    if (numbers == NULL) {
        return alpi_fail(linear->context, ALP_ERROR_INVALID_ARGUMENT, "film: `numbers` is NULL");
    }
    development d = {.options = options != NULL ? *options : alp_film_options_default()};
    ALP_TRY(prepare(&d, linear));
    *numbers = (alp_film_numbers){.exposure = d.options.exposure, .gain = d.gain, .white = d.white};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            numbers->balance[i][k] = d.balanced ? d.balance.m[i][k] : (i == k ? 1.0 : 0.0);
        }
    }
    return ALP_OK;
}

alp_result alp_film_develop(const alp_image *linear, const alp_film_options *options,
                            alp_image **display, double *exposure)
{
    if (display != NULL) {
        *display = NULL;
    }
    ALP_TRY(alpi_film_check(linear, options));
    if (display == NULL) {
        return alpi_fail(linear->context, ALP_ERROR_INVALID_ARGUMENT, "film: `display` is NULL");
    }
    development d = {.options = options != NULL ? *options : alp_film_options_default()};
    ALP_TRY(prepare(&d, linear));
    alp_image_info info = {linear->info.width, linear->info.height, 3, ALP_COMPONENT_U8};
    ALP_TRY(alp_image_create(linear->context, info, display));
    develop_pixels(&d, linear, alp_image_bytes(*display));
    if (exposure != NULL) {
        *exposure = d.options.exposure;
    }
    return ALP_OK;
}
