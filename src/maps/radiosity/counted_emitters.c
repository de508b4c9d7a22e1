// SPDX-License-Identifier: MIT
#include "maps/radiosity/counted_emitters.h"

#include "base/memory.h"

#include <string.h>

static void add_to(const alpi_gather_job *job, const alpi_reference_value *values,
                   const alpi_directional *directional)
{
    for (uint32_t i = 0; i < job->count; i++) {
        const uint32_t t = job->list != NULL ? job->list[i] : i;
        for (int k = 0; k < 3; k++) {
            job->values[t].mean[k] += values[t].mean[k];
        }
        if (directional != NULL) {
            alpi_directional_mix(&job->directional[t], 1.0f, &directional[t], 1.0f);
        }
    }
}

alp_result alpi_counted_emitters_add(const alpi_gather_job *job, const alpi_task_progress *progress)
{
    const uint32_t count = job->receivers->count;
    const alpi_gather_scene from = {.scene = job->from->scene,
                                    .tracer = job->from->tracer,
                                    .filter = job->from->filter,
                                    .emitters = true};
    alpi_gather_job own = {.context = job->context,
                           .from = &from,
                           .gatherer = job->gatherer,
                           .receivers = job->receivers,
                           .list = job->list,
                           .count = job->count};
    own.values = ALPI_NEW(job->context, alpi_reference_value, count);
    if (job->directional != NULL) {
        own.directional = ALPI_NEW(job->context, alpi_directional, count);
    }
    const bool room = own.values != NULL && (job->directional == NULL || own.directional != NULL);
    const alp_result result =
        room ? alpi_gather_irradiance(&own, progress) : ALP_ERROR_OUT_OF_MEMORY;
    if (result == ALP_OK) {
        add_to(job, own.values, own.directional);
    }
    alpi_release(job->context, own.values);
    alpi_release(job->context, own.directional);
    return result;
}

alp_result alpi_scene_without_emitters(const alp_scene *scene, alp_scene *dark)
{
    *dark = (alp_scene){0};
    alpi_material *materials = ALPI_NEW(scene->context, alpi_material, scene->material_count);
    if (materials == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t m = 0; m < scene->material_count; m++) {
        materials[m] = scene->materials[m];
        memset(materials[m].emission, 0, sizeof materials[m].emission);
    }
    *dark = *scene;
    dark->materials = materials;
    return ALP_OK;
}

void alpi_scene_without_emitters_clear(alp_scene *dark)
{
    if (dark->context != NULL) {
        alpi_release(dark->context, dark->materials);
    }
    *dark = (alp_scene){0};
}
