// SPDX-License-Identifier: MIT
// The sky by direction, for hosts that draw it.
#include "base/context.h"
#include "scene/lights/lighting_options.h"
#include "scene/sky/sky.h"

alp_result alp_sky_radiance(alp_context *context, const alp_lighting_options *lighting,
                            uint32_t count, const float (*directions)[3], float (*radiance)[3])
{
    const vec3 black = {0.0f, 0.0f, 0.0f};
    alpi_sky *sky = NULL;
    if (context == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (lighting == NULL || (count > 0 && (directions == NULL || radiance == NULL))) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "sky: lighting, directions and radiance may not be NULL");
    }
    ALP_TRY(alpi_lighting_options_check(context, lighting));
    ALP_TRY(alpi_sky_create(context, &lighting->sky, alpi_sun_direction(&lighting->sun), &sky));
    for (uint32_t i = 0; i < count; i++) {
        const vec3 direction = vec3_load(directions[i]);
        vec3_store(radiance[i], sky != NULL ? alpi_sky_radiance(sky, direction) : black);
    }
    alpi_sky_destroy(context, sky);
    return ALP_OK;
}
