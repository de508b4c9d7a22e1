// SPDX-License-Identifier: MIT
// Linear light to what a screen shows.
#include "base/image.h"

#include <alpenglow/display.h>

#include <math.h>

/// Neither black nor white, so that both stand out from it.
static const uint8_t BACKGROUND = 96;

static uint8_t encode(float linear)
{
    return (uint8_t)(alpi_linear_to_srgb(linear) * 255.0f + 0.5f); // NaN shows as black
}

/// Grey over grey: light is mixed linearly, so that an edge has no dark or bright rim.
static void display_pixel(const float rgba[4], uint8_t pixel[3])
{
    float alpha = rgba[3] >= 0.0f ? fminf(rgba[3], 1.0f) : 0.0f;
    float background = alpi_srgb_to_linear((float)BACKGROUND / 255.0f);
    for (int k = 0; k < 3; k++) {
        float value = alpha > 0.0f ? rgba[k] : 0.0f; // what is under alpha 0 is not looked at
        float clamped = fminf(fmaxf(value, 0.0f), 1.0f);
        pixel[k] = encode(alpha * clamped + (1.0f - alpha) * background);
    }
}

alp_result alp_image_to_display(const alp_image *linear, alp_image **display)
{
    if (display != NULL) {
        *display = NULL;
    }
    if (linear == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (display == NULL || linear->info.component != ALP_COMPONENT_FLOAT) {
        return alpi_fail(linear->context, ALP_ERROR_INVALID_ARGUMENT,
                         display == NULL ? "display: the place for the image is NULL"
                                         : "display: a linear float image is needed, not 8 bits");
    }
    alp_image_info info = {linear->info.width, linear->info.height, 3, ALP_COMPONENT_U8};
    ALP_TRY(alp_image_create(linear->context, info, display));
    uint8_t *pixel = alp_image_bytes(*display);
    for (uint32_t y = 0; y < info.height; y++) {
        for (uint32_t x = 0; x < info.width; x++, pixel += 3) {
            float rgba[4];
            alpi_image_pixel(linear, x, y, rgba);
            display_pixel(rgba, pixel);
        }
    }
    return ALP_OK;
}
