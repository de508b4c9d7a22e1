// SPDX-License-Identifier: MIT
// Direct and bounced light put together, and what their errors are not told by their own rays.
#include "bake/layers.h"
#include "bake/light/light.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>

enum { TEXELS_PER_RANGE = 4096 };

/// Noise of the light that rays meet, over the mean, times the root of the rays that blocks gather
/// by. Measured by other seeds of the blocks alone, 32 rays (living_room: 128), for the texels of
/// the truth table: it is .28 % of the mean at 32 rays, and was .32 % (cornell), .23 % (windows),
/// .19 % (teapot-room), .61 % (atrium), .22 % (zdm2), and of living_room .04 % instead of .14 %, as
/// little of its light is bounced; their root mean square, as of 32 rays, .32 %.
static const double SOLVED_NOISE = 0.016;
/// The most of it, over bounced light: that of the atrium, where it is most of that.
static const double MOST_OF_BOUNCED = 0.16;

/// Whether rays of texels meet light that blocks gathered; else they meet direct light alone.
static bool meets_solved(const alpi_radiosity_options *o)
{
    return o->bounces > 1 || o->direct != o->lighting;
}

double alpi_light_solved_error(const alpi_radiosity *solution, double mean, double bounced,
                               double noise)
{
    if (!meets_solved(&solution->options) || !(mean > 0.0)) {
        return 0.0;
    }
    return fmin(SOLVED_NOISE, MOST_OF_BOUNCED * bounced / mean) * noise;
}

static void state_solved(alpi_reference_value *value, const float *sky, double share)
{
    for (int k = 0; k < 3; k++) {
        const double error = share * (double)(value->mean[k] - (sky != NULL ? sky[k] : 0.0f));
        value->variance[k] += (float)(error * error);
    }
}

/// Makes of bounced light, and the sky's that came with it, what a map holds.
/// @param direct NULL: it holds neither that nor the sky's
static void add_direct(alpi_reference_value *value, const float *sky,
                       const alpi_reference_value *direct)
{
    for (int k = 0; k < 3; k++) {
        const float of_sky = sky != NULL ? sky[k] : 0.0f, bounced = value->mean[k] - of_sky;
        value->mean[k] = bounced + (direct != NULL ? direct->mean[k] + of_sky : 0.0f);
        value->variance[k] += direct != NULL ? direct->variance[k] : 0.0f;
    }
}

typedef struct peek_job {
    const alpi_light_task *task;
    const alpi_reference_value *direct; // or NULL
    const float (*skies)[3];
    double share;
    alpi_reference_value *whole;
} peek_job;

static alp_result peek_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const peek_job *p = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t texel = p->task->order[i];
        const float *sky = p->skies != NULL ? p->skies[texel] : NULL;
        p->whole[texel] = p->task->values[texel];
        state_solved(&p->whole[texel], sky, p->share);
        add_direct(&p->whole[texel], sky, p->direct != NULL ? &p->direct[texel] : NULL);
    }
    return ALP_OK;
}

alp_result alpi_light_peek(const alpi_bake_job *job, const alpi_light_task *task,
                           const alpi_radiosity *solution, const float (*skies)[3], double share,
                           alpi_reference_value *whole)
{
    const bool on = job->options.light.direct != ALP_DIRECT_OFF;
    peek_job p = {task, on ? solution->direct : NULL, skies, share, whole};
    return alpi_parallel_for(job->context, task->count, TEXELS_PER_RANGE, peek_range, &p, NULL);
}

typedef struct sum_job {
    alpi_bake_job *job;
    const alpi_light_task *task;
    const alpi_radiosity *solution;
    const float (*skies)[3];
    double share;
    bool on; // direct light
} sum_job;

static alp_result sum_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const sum_job *s = user;
    alpi_bake_job *job = s->job;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t texel = s->task->order[i];
        const float *sky = s->skies != NULL ? s->skies[texel] : NULL;
        const alpi_reference_value *direct = &s->solution->direct[texel];
        alpi_reference_value *value = &s->task->values[texel];
        state_solved(value, sky, s->share);
        for (int k = 0; k < 3 && job->direct != NULL; k++) {
            const float of_sky = sky != NULL ? sky[k] : 0.0f;
            job->direct[texel][k] = direct->mean[k] + of_sky;
            job->bounced[texel][k] = value->mean[k] - of_sky;
        }
        add_direct(value, sky, s->on ? direct : NULL);
        if (s->on && s->task->directional != NULL) {
            alpi_directional_mix(&s->task->directional[texel], 1.0f,
                                 &s->solution->directional[texel], 1.0f);
        }
    }
    return ALP_OK;
}

alp_result alpi_light_sum(alpi_bake_job *job, const alpi_light_task *task,
                          const alpi_radiosity *solution, const float (*skies)[3], double share)
{
    const uint32_t texels = task->receivers->count;
    if (alpi_bake_lights_apart(&job->options)) {
        ALPI_TRY_NEW(job->context, job->direct, texels);
        ALPI_TRY_NEW(job->context, job->bounced, texels);
    }
    const bool on = job->options.light.direct != ALP_DIRECT_OFF;
    sum_job sum = {job, task, solution, skies, share, on};
    ALP_TRY(alpi_parallel_for(job->context, task->count, TEXELS_PER_RANGE, sum_range, &sum, NULL));
    alpi_bake_sum_layers(job, task->order, task->count, skies, on, task->values);
    return ALP_OK;
}
