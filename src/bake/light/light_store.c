// SPDX-License-Identifier: MIT
#include "bake/light/light_store.h"

#include "bake/light/light_error.h"
#include "bake/light/light_layers.h"
#include "bake/settings.h"
#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>

enum { TEXELS_PER_RANGE = 4096 };

typedef struct parts_job {
    const alpi_light_bake *light;
    const alpi_radiosity *solution;
    const float (*skies)[3];
} parts_job;

/// Keeps direct and bounced light apart, and adds direct light to the light by direction.
static alp_result keep_parts(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const parts_job *p = user;
    const alpi_light_bake *light = p->light;
    const alpi_bake_job *job = light->job;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = light->order[i];
        for (int k = 0; k < 3 && job->direct != NULL; k++) {
            const float sky = p->skies != NULL ? p->skies[t][k] : 0.0f;
            job->direct[t][k] = p->solution->direct[t].mean[k] + sky;
            job->bounced[t][k] = light->values[t].mean[k] - sky;
        }
        if (light->directional != NULL && job->options.light.direct != ALP_DIRECT_OFF) {
            alpi_directional_mix(&light->directional[t], 1.0f, &p->solution->directional[t], 1.0f);
        }
    }
    return ALP_OK;
}

alp_result alpi_light_finish(alpi_light_bake *light, const alpi_light_rounds *r)
{
    alpi_bake_job *job = light->job;
    const float(*skies)[3] = (const float(*)[3])r->skies;
    const uint32_t texels = light->receivers->count;
    if (alpi_bake_lights_apart(&job->options)) {
        ALPI_TRY_NEW(job->context, job->direct, texels);
        ALPI_TRY_NEW(job->context, job->bounced, texels);
    }
    parts_job parts = {light, r->solution, skies};
    ALP_TRY(
        alpi_parallel_for(job->context, light->count, TEXELS_PER_RANGE, keep_parts, &parts, NULL));
    ALP_TRY(alpi_light_join(light, r->solution, skies, alpi_light_solved_share(r), light->values));
    alpi_light_sum_layers(light, skies, job->options.light.direct != ALP_DIRECT_OFF);
    return ALP_OK;
}

static alp_result store_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_light_bake *light = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = light->order[i];
        const alpi_reference_value *v = &light->values[t];
        for (int k = 0; k < 3; k++) {
            light->job->irradiance[t][k] = v->mean[k];
            light->job->irradiance_errors[t][k] = sqrtf(v->variance[k]);
        }
    }
    return ALP_OK;
}

alp_result alpi_light_store(alpi_light_bake *light)
{
    alpi_bake_job *job = light->job;
    const uint32_t texels = light->receivers->count;
    const alp_light_options *o = &job->options.light;
    const bool stated = o->gather != ALP_GATHER_HEMICUBE || o->bounces == 0;
    alpi_light_error error;
    ALPI_TRY_NEW(job->context, job->irradiance, texels);
    ALPI_TRY_NEW(job->context, job->irradiance_errors, texels);
    ALP_TRY(
        alpi_parallel_for(job->context, light->count, TEXELS_PER_RANGE, store_range, light, NULL));
    ALP_TRY(alpi_light_find_error(light, light->values, &error));
    job->report.light_mean = error.mean;
    job->report.light_scale = error.scale;
    job->report.light_relative_error = stated ? error.over_scale.rms : (double)NAN;
    job->report.light_p99_error = stated ? error.over_scale.p99 : (double)NAN;
    return ALP_OK;
}
