// SPDX-License-Identifier: MIT
// Stand-in until the sky is written: CONSTANT and NONE only.
#include "scene/sky.h"

#include "base/memory.h"
#include "base/warp.h"

struct alpi_sky {
    vec3 radiance;
};

alp_result alpi_sky_create(alp_context *context, const alp_sky_options *options, vec3 sun_direction,
                           alpi_sky **sky)
{
    (void)sun_direction;
    *sky = NULL;
    if (options->kind == ALP_SKY_NONE) {
        return ALP_OK;
    }
    if (options->kind != ALP_SKY_CONSTANT) {
        return alpi_fail(context, ALP_ERROR_UNSUPPORTED, "sky: only a constant one is known yet");
    }
    ALPI_TRY_NEW(context, *sky, 1);
    (*sky)->radiance = vec3_scale(vec3_load(options->up), options->strength);
    return ALP_OK;
}

void alpi_sky_destroy(alp_context *context, alpi_sky *sky)
{
    alpi_release(context, sky);
}

vec3 alpi_sky_radiance(const alpi_sky *sky, vec3 direction)
{
    (void)direction;
    return sky->radiance;
}

vec3 alpi_sky_sample(const alpi_sky *sky, vec2 u, float *density)
{
    *density = alpi_sky_density(sky, (vec3){0.0f, 0.0f, 1.0f});
    return alpi_warp_uniform_cone(u, -1.0f);
}

float alpi_sky_density(const alpi_sky *sky, vec3 direction)
{
    (void)sky;
    (void)direction;
    return (float)(0.25 / ALPI_PI);
}

vec3 alpi_sky_mean(const alpi_sky *sky)
{
    return sky->radiance;
}
