// SPDX-License-Identifier: MIT
// Takes noise off the bounced light of a bake.
#include "bake/light/light.h"

#include "base/memory.h"
#include "maps/denoise.h"

#include <math.h>
#include <string.h>

/// The texels of the order as the denoiser wants them.
typedef struct denoise_arrays {
    float (*means)[3], (*variances)[3], (*positions)[3], (*normals)[3];
    float *sides;
} denoise_arrays;

static void fill_arrays(const alpi_light_task *task, const denoise_arrays *a)
{
    const alpi_texels *texels = task->lattice->texels;
    for (uint32_t i = 0; i < task->count; i++) {
        const uint32_t t = task->order[i];
        const alpi_reference_value *v = &task->values[t];
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

static alp_result filter(alpi_bake_job *job, const alpi_light_task *task, float (*skies)[3],
                         denoise_arrays *a)
{
    alp_context *context = job->context;
    const uint32_t count = task->count;
    ALPI_TRY_NEW(context, a->means, count);
    ALPI_TRY_NEW(context, a->variances, count);
    ALPI_TRY_NEW(context, a->positions, count);
    ALPI_TRY_NEW(context, a->normals, count);
    ALPI_TRY_NEW(context, a->sides, count);
    fill_arrays(task, a);
    const alpi_denoise_texels texels = {.count = count,
                                        .means = (const float(*)[3])a->means,
                                        .variances = (const float(*)[3])a->variances,
                                        .positions = (const float(*)[3])a->positions,
                                        .normals = (const float(*)[3])a->normals,
                                        .sides = a->sides};
    alpi_task_progress told = task->progress;
    told.stage = "denoise";
    ALP_TRY(alpi_denoise(context, task->tracer, &texels, &told, a->means, a->variances));
    for (uint32_t i = 0; i < count; i++) {
        alpi_reference_value *v = &task->values[task->order[i]];
        float *sky = skies != NULL ? skies[task->order[i]] : NULL;
        for (int k = 0; k < 3; k++) {
            const float mean = fmaxf(a->means[i][k], 0.0f);
            if (sky != NULL) {
                sky[k] *= v->mean[k] > 0.0f ? mean / v->mean[k] : 1.0f; // keeps its share
            }
            v->mean[k] = mean;
            v->variance[k] = a->variances[i][k];
        }
    }
    return ALP_OK;
}

/// Takes noise off the bounced light; direct light has edges that must stay.
static alp_result denoise(alpi_bake_job *job, const alpi_light_task *task, float (*skies)[3])
{
    alp_context *context = job->context;
    denoise_arrays a = {0};
    task->clock->deadline = HUGE_VAL; // what is whole is filtered as a whole
    task->clock->ended = false;       // unless the user says no
    const alp_result result = filter(job, task, skies, &a);
    alpi_release(context, a.means);
    alpi_release(context, a.variances);
    alpi_release(context, a.positions);
    alpi_release(context, a.normals);
    alpi_release(context, a.sides);
    return result;
}

alp_result alpi_light_denoise(alpi_bake_job *job, const alpi_light_task *task, float (*skies)[3])
{
    alpi_light_clock *clock = task->clock;
    job->stage = "denoise";
    const alp_result result = clock->refused ? ALP_ERROR_CANCELLED : denoise(job, task, skies);
    if (result != ALP_ERROR_CANCELLED || !clock->refused || !job->options.sampling.keep_partial) {
        return result;
    }
    job->report.cut_off = true;
    clock->ended = true; // asked again it would cancel what it wanted kept
    alpi_warn(job->context, "not-denoised", job->scene->name,
              "light was interrupted before denoising; its noise remains");
    return ALP_OK;
}
