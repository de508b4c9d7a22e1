// SPDX-License-Identifier: MIT
// Irradiance as pixels: a picture of E by normal, for a renderer that looks it up in a texture.
// Based on: G. King. Real-Time Computation of Dynamic Irradiance Environment Maps. GPU Gems 2.
//           2005.
#include "base/context.h"
#include "sh/equirect.h"
#include "sh/sh9.h"

enum { WIDTH_LIMIT = 16384 };

alp_result alp_sh_irradiance_image(alp_context *context, const alp_sh9 *radiance,
                                   alp_sh_reading reading, uint32_t width, alp_image **image)
{
    if (context == NULL || radiance == NULL || image == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *image = NULL;
    if (width < 2 || width > WIDTH_LIMIT || width % 2 != 0) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "irradiance map %u wide: give an even number, 2 to %d", width,
                         WIDTH_LIMIT);
    }
    const uint32_t height = width / 2;
    const alp_image_info info = {width, height, 3, ALP_COMPONENT_FLOAT};
    ALP_TRY(alp_image_create(context, info, image));
    float *pixel = alp_image_floats(*image);
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++, pixel += 3) {
            vec3_store(pixel, alpi_sh9_read(radiance, alpi_equirect_direction(width, height, x, y),
                                            reading));
        }
    }
    return ALP_OK;
}
