// SPDX-License-Identifier: MIT
// The stated error of light in two numbers, what the texels that err most are made of, and what is
// said where they are too large.
#include "bake/light/light_error.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <string.h>

static double sum_variances(const alpi_reference_value *v)
{
    return (double)v->variance[0] + (double)v->variance[1] + (double)v->variance[2];
}

typedef struct error_job {
    const alpi_reference_value *values;
    const uint32_t *order;
    float *errors; // [texels] out
} error_job;

/// Sums means and variances of the channels.
static void sum_errors(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const error_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const alpi_reference_value *v = &job->values[job->order[i]];
        const double square = sum_variances(v);
        sums[0] += (double)v->mean[0] + (double)v->mean[1] + (double)v->mean[2];
        sums[1] += square;
        job->errors[job->order[i]] = (float)sqrt(square / 3.0); // of its channels
    }
}

alp_result alpi_light_find_error(alp_context *context, const alpi_reference_value *values,
                                 const alpi_light_task *task, alpi_light_error *error)
{
    double sums[ALPI_SUM_LIMIT] = {0.0}, p99 = 0.0;
    const error_job job = {values, task->order, ALPI_NEW(context, float, task->receivers->count)};
    if (job.errors == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = alpi_parallel_sum(context, task->count, sum_errors, &job, NULL, sums);
    if (result == ALP_OK) {
        result = alpi_percentile(context, job.errors, task->order, task->count, 0.99, &p99);
    }
    alpi_release(context, job.errors);
    const double all = 3.0 * fmax((double)task->count, 1.0), mean = sums[0] / all;
    const double scale = alpi_light_scale(task, mean);
    *error = (alpi_light_error){mean, scale, {(double)NAN, (double)NAN}};
    if (scale > 0.0) {
        error->over_scale.rms = sqrt(sums[1] / all) / scale;
        error->over_scale.p99 = p99 / scale;
    }
    return result;
}

/// Squared errors of texels at the limit, channels summed.
static double square_at(const alpi_light_error *error, double limit)
{
    return 3.0 * pow(limit * error->scale, 2.0);
}

/// Of it: that of half the limit.
static const double HALF = 0.25;
/// Of a texel's squared error: what is bounced light's is worth rays from here on.
static const double BOUNCED = 0.25;

double alpi_light_tail(const alpi_light_whole *whole, const alpi_light_error *error, double limit,
                       alpi_light_noise *noise)
{
    const double above = square_at(error, limit);
    double all = 0.0, direct = 0.0, bounced = 0.0;
    uint32_t noisy = 0;
    for (uint32_t i = 0; i < whole->count; i++) {
        const uint32_t t = whole->order[i];
        const double square = sum_variances(&whole->values[t]);
        noisy += square > HALF * above ? 1u : 0u;
        if (square > above) {
            all += square;
            direct += whole->direct != NULL ? sum_variances(&whole->direct[t]) : 0.0;
            bounced += sum_variances(&whole->bounced[t]);
        }
    }
    *noise = (alpi_light_noise){.noisy = (double)noisy / fmax((double)whole->count, 1.0)};
    if (!(all > 0.0)) {
        return 0.0;
    }
    noise->direct = error->over_scale.p99 * sqrt(direct / all);
    noise->bounced = error->over_scale.p99 * sqrt(bounced / all);
    return error->over_scale.p99 * sqrt(fmax(all - direct - bounced, 0.0) / all);
}

void alpi_light_find_worst(const alpi_light_whole *whole, const alpi_light_error *error,
                           uint32_t texels, double limit, const uint8_t *between,
                           alpi_light_worst *worst)
{
    const double above = square_at(error, limit);
    uint32_t beyond = 0, beyond_between = 0;
    memset(worst->marks, 0, texels);
    worst->count = 0;
    for (uint32_t i = 0; i < whole->count; i++) {
        const uint32_t t = whole->order[i];
        const double square = sum_variances(&whole->values[t]);
        const bool bounced = sum_variances(&whole->bounced[t]) > BOUNCED * square;
        worst->marks[t] = square > HALF * above;
        if (worst->marks[t] != 0 && bounced) {
            worst->list[worst->count] = t;
            worst->count += between[t] == 0;
        }
        beyond += square > above && bounced;
        beyond_between += square > above && bounced && between[t] != 0;
    }
    if (2 * beyond_between > beyond) {
        worst->count = 0;
    }
}

void alpi_light_warn(const alpi_bake_job *job, const alpi_relative_error *error, bool cut_off,
                     uint32_t rays, uint32_t direct)
{
    const double wanted = (double)job->options.light.error;
    const double stated = isfinite(error->rms) ? error->rms : 0.0; // in the dark there is none
    if (cut_off) {
        alpi_warn(job->context, "cut-off", job->scene->name,
                  "light was cut off after %u rays per texel and %u samples of each light; the "
                  "stated error is %.2g %%, and another run gives other bits",
                  rays, direct, 100.0 * stated);
    } else if (wanted > 0.0 && job->report.light_bounded &&
               (error->rms > wanted || error->p99 > ALPI_P99_LIMIT * wanted)) {
        alpi_note(job->context, "ray-limit", job->scene->name,
                  "light ended by the limit of rays of a bake without --error: the stated error is "
                  "%.2g %%, of the worst texel in a hundred %.2g %%; --error %g goes on",
                  100.0 * stated, 100.0 * error->p99, 100.0 * wanted);
    } else if (wanted > 0.0 && error->rms > wanted) {
        alpi_warn(job->context, "error-not-reached", job->scene->name,
                  "the stated error of the light is %.2g %% after %u rays per texel and %u "
                  "samples of each light, wanted %.2g %%",
                  100.0 * error->rms, rays, direct, 100.0 * wanted);
    } else if (wanted > 0.0 && error->p99 > ALPI_P99_LIMIT * wanted) {
        alpi_warn(
            job->context, "error-not-reached", job->scene->name,
            "the stated error of the light is %.2g %%, as wanted, but one texel in a hundred has"
            " more than %.2g %% after up to %u rays per texel and up to %u samples of each "
            "light, wanted at most %.2g %%",
            100.0 * error->rms, 100.0 * error->p99, rays, direct, 100.0 * ALPI_P99_LIMIT * wanted);
    }
}
