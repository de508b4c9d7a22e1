// SPDX-License-Identifier: MIT
#include "bake/light/light_denoise.h"

#include "base/memory.h"
#include "maps/denoise.h"

#include <math.h>
#include <string.h>

/// Arrays of the texels of the order, for the denoiser.
typedef struct denoise_arrays {
    float (*means)[3], (*variances)[3], (*positions)[3], (*normals)[3];
    float *sides;
} denoise_arrays;

static void fill_arrays(const alpi_light_bake *light, const denoise_arrays *a)
{
    const alpi_texels *texels = light->lattice->texels;
    for (uint32_t i = 0; i < light->count; i++) {
        const uint32_t t = light->order[i];
        const alpi_reference_value *v = &light->values[t];
        alpi_receiver_point point;
        alpi_texels_point(texels, t, &point);
        const float position[3] = {point.position.x, point.position.y, point.position.z};
        memcpy(a->positions[i], position, sizeof position);
        memcpy(a->normals[i], texels->normals[t], sizeof texels->normals[t]);
        memcpy(a->means[i], v->mean, sizeof v->mean);
        memcpy(a->variances[i], v->variance, sizeof v->variance);
        a->sides[i] = sqrtf(texels->areas[t] / texels->coverages[t]);
    }
}

static alp_result filter(const alpi_light_bake *light, float (*skies)[3], denoise_arrays *a)
{
    alp_context *context = light->job->context;
    const uint32_t count = light->count;
    ALPI_TRY_NEW(context, a->means, count);
    ALPI_TRY_NEW(context, a->variances, count);
    ALPI_TRY_NEW(context, a->positions, count);
    ALPI_TRY_NEW(context, a->normals, count);
    ALPI_TRY_NEW(context, a->sides, count);
    fill_arrays(light, a);
    const alpi_denoise_texels texels = {.count = count,
                                        .means = (const float(*)[3])a->means,
                                        .variances = (const float(*)[3])a->variances,
                                        .positions = (const float(*)[3])a->positions,
                                        .normals = (const float(*)[3])a->normals,
                                        .sides = a->sides};
    alpi_task_progress progress = light->progress;
    progress.stage = "denoise";
    ALP_TRY(alpi_denoise(context, light->tracer, &texels, &progress, a->means, a->variances));
    for (uint32_t i = 0; i < count; i++) {
        alpi_reference_value *v = &light->values[light->order[i]];
        float *sky = skies != NULL ? skies[light->order[i]] : NULL;
        for (int k = 0; k < 3; k++) {
            const float mean = fmaxf(a->means[i][k], 0.0f);
            if (sky != NULL) {
                sky[k] *= v->mean[k] > 0.0f ? mean / v->mean[k] : 1.0f;
            }
            v->mean[k] = mean;
            v->variance[k] = a->variances[i][k];
        }
    }
    return ALP_OK;
}

/// Filters bounced light. Direct light has edges that must stay.
static alp_result denoise(const alpi_light_bake *light, float (*skies)[3])
{
    alp_context *context = light->job->context;
    denoise_arrays a = {0};
    light->clock->deadline = HUGE_VAL; // the filter runs to its end
    light->clock->ended = false;       // unless the user cancels
    const alp_result result = filter(light, skies, &a);
    alpi_release(context, a.means);
    alpi_release(context, a.variances);
    alpi_release(context, a.positions);
    alpi_release(context, a.normals);
    alpi_release(context, a.sides);
    return result;
}

alp_result alpi_light_denoise(const alpi_light_bake *light, float (*skies)[3])
{
    alpi_light_clock *clock = light->clock;
    alpi_bake_job *job = light->job;
    job->stage = "denoise";
    const alp_result result = clock->refused ? ALP_ERROR_CANCELLED : denoise(light, skies);
    if (result != ALP_ERROR_CANCELLED || !clock->refused || !job->options.sampling.keep_partial) {
        return result;
    }
    job->report.cut_off = true;
    clock->ended = true; // the callback would cancel what is kept
    alpi_warn(job->context, "not-denoised", job->scene->name,
              "light was interrupted before denoising; its noise remains");
    return ALP_OK;
}
