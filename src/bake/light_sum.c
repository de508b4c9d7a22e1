// SPDX-License-Identifier: MIT
// Direct and bounced light put together.
#include "bake/layers.h"
#include "bake/light.h"

#include "base/memory.h"

alp_result alpi_light_sum(alpi_bake_job *job, const alpi_light_task *task,
                          const alpi_radiosity *solution, float (*skies)[3])
{
    const uint32_t texels = task->receivers->count;
    if (alpi_bake_lights_apart(job)) {
        ALPI_TRY_NEW(job->context, job->direct, texels);
        ALPI_TRY_NEW(job->context, job->bounced, texels);
    }
    const bool on = job->options.light.direct != ALP_DIRECT_OFF;
    for (uint32_t i = 0; i < task->count; i++) {
        const uint32_t texel = task->order[i];
        const alpi_reference_value *direct = &solution->direct[texel];
        alpi_reference_value *value = &task->values[texel];
        for (int k = 0; k < 3; k++) {
            const float sky = skies != NULL ? skies[texel][k] : 0.0f;
            const float bounced = value->mean[k] - sky;
            if (job->direct != NULL) {
                job->direct[texel][k] = direct->mean[k] + sky;
                job->bounced[texel][k] = bounced;
            }
            value->mean[k] = bounced + (on ? direct->mean[k] + sky : 0.0f);
            value->variance[k] += on ? direct->variance[k] : 0.0f;
        }
        if (on && task->directional != NULL) {
            alpi_directional_mix(&task->directional[texel], 1.0f, &solution->directional[texel],
                                 1.0f);
        }
    }
    alpi_bake_sum_layers(job, task->order, task->count, (const float(*)[3])skies, on, task->values);
    return ALP_OK;
}
