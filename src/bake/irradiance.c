// SPDX-License-Identifier: MIT
// Irradiance at the texels of a bake, by the reference.
#include "bake/job.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/stated_error.h"
#include "transport/examine.h"
#include "transport/reference.h"

#include <math.h>

bool alpi_bake_wants_occlusion(const alpi_bake_job *job)
{
    return (job->options.maps & (ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_OBSCURANCE)) != 0;
}

/// Takes means and standard errors of the listed texels, and the stated error of the whole.
/// @param errors [texels] scratch: of each texel, root mean square over its channels
static alp_result take_values(alpi_bake_job *job, const uint32_t *order, uint32_t count,
                              const alpi_reference_value *values, float *errors)
{
    double mean = 0.0, squares = 0.0, p99 = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const alpi_reference_value *v = &values[order[i]];
        double square = 0.0;
        for (int k = 0; k < 3; k++) {
            job->irradiance[order[i]][k] = v->mean[k];
            job->irradiance_errors[order[i]][k] = sqrtf(v->variance[k]);
            mean += (double)v->mean[k];
            square += (double)v->variance[k];
        }
        errors[order[i]] = (float)sqrt(square / 3.0);
        squares += square;
    }
    ALP_TRY(alpi_percentile(job->context, errors, order, count, 0.99, &p99));
    const double all = 3.0 * fmax((double)count, 1.0);
    alp_bake_report *r = &job->report;
    r->light_mean = mean / all;
    r->light_relative_error = mean > 0.0 ? sqrt(squares / all) / r->light_mean : (double)NAN;
    r->light_p99_error = mean > 0.0 ? p99 / r->light_mean : (double)NAN;
    return ALP_OK;
}

static alp_result gather(alpi_bake_job *job, const alpi_lighting *lighting,
                         const alpi_tracer *tracer, const alpi_receivers *receivers,
                         const uint32_t *order, uint32_t count, const alpi_task_progress *progress)
{
    const alp_bake_options *o = &job->options;
    const uint32_t limit = ALPI_REFERENCE_BOUNCE_LIMIT;
    const alpi_reference reference = {
        .context = job->context,
        .scene = job->scene,
        .tracer = tracer,
        .lighting = lighting,
        .filter = {.one_sided = o->occlusion.one_sided},
        .bounces = o->light.bounces < limit ? o->light.bounces : limit,
        .samples = o->light.samples,
        .next_event = true,
        .share = true,
        .seed = o->occlusion.seed,
    };
    alpi_reference_value *values = ALPI_NEW(job->context, alpi_reference_value, receivers->count);
    float *errors = ALPI_NEW(job->context, float, receivers->count);
    alp_result result = values != NULL && errors != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    alpi_task_progress told = *progress;
    told.stage = "light";
    if (result == ALP_OK) {
        result = alpi_reference_irradiance(&reference, receivers, order, count, &told, values);
    }
    if (result == ALP_OK) {
        result = take_values(job, order, count, values, errors);
        job->report.light_samples = alpi_reference_samples(&reference);
        job->report.rays += (uint64_t)count * job->report.light_samples;
    }
    alpi_release(job->context, values);
    alpi_release(job->context, errors);
    return result;
}

alp_result alpi_bake_irradiance(alpi_bake_job *job, const alpi_tracer *tracer,
                                const alpi_receivers *receivers, const uint32_t *order,
                                uint32_t count, const alpi_task_progress *progress)
{
    if (job->irradiance == NULL) {
        return ALP_OK;
    }
    alpi_lighting *lighting = NULL;
    ALP_TRY(alpi_lighting_create(job->scene, &job->options.light.lighting, &lighting));
    const alpi_trace_filter filter = {.one_sided = job->options.occlusion.one_sided};
    alp_result result = alpi_examine_light(tracer, filter, job->scene, lighting, progress->callback,
                                           progress->user);
    if (result == ALP_OK) {
        result = gather(job, lighting, tracer, receivers, order, count, progress);
    }
    alpi_lighting_destroy(job->context, lighting);
    return result;
}
