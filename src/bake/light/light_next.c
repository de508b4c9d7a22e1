// SPDX-License-Identifier: MIT
// How far rounds of light have come, and what the next one is for.
#include "bake/light/light_next.h"

#include "base/tasks.h"
#include "transport/gather/cosine_rays.h"

#include <math.h>

enum { MOST_SAMPLES = 65536 };
/// Share of the texels whose direct light more samples would go to, at least: they are counted for
/// one way to share out the error of many.
static const double LEAST_NOISY = 0.05;

uint32_t alpi_light_round_most_rays(const alp_light_options *o)
{
    return o->error > 0.0f ? MOST_SAMPLES
                           : alpi_cosine_rays_samples(o->samples, ALPI_LIGHT_REPLICATES);
}

// --- errors --------------------------------------------------------------------------------------

/// Texels of which something is summed.
typedef struct some_texels {
    const alpi_light_round_state *round;
    const uint32_t *list;
} some_texels;

static void sum_direct(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const some_texels *some = user;
    for (uint32_t i = begin; i < end; i++) {
        const alpi_reference_value *d = &some->round->solution->direct[some->list[i]];
        for (int k = 0; k < 3; k++) {
            sums[0] += (double)d->mean[k];
            sums[1] += (double)d->variance[k];
        }
    }
}

static void sum_bounced(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const some_texels *some = user;
    const alpi_light_round_state *r = some->round;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = some->list[i];
        const alpi_reference_value *b = &r->task->values[t];
        for (int k = 0; k < 3; k++) {
            const double bounced =
                (double)b->mean[k] - (r->skies != NULL ? (double)r->skies[t][k] : 0.0);
            sums[0] += (double)b->mean[k];
            sums[1] += (double)b->variance[k];
            sums[2] += bounced * bounced;
            sums[3] += bounced;
        }
    }
}

alp_result alpi_light_round_measure(alpi_light_round_state *r, const uint32_t *list, uint32_t count)
{
    const some_texels all = {r, r->task->order}, known = {r, list};
    double d[ALPI_SUM_LIMIT] = {0.0}, b[ALPI_SUM_LIMIT] = {0.0};
    ALP_TRY(alpi_parallel_sum(r->job->context, r->task->count, sum_direct, &all, NULL, d));
    ALP_TRY(alpi_parallel_sum(r->job->context, count, sum_bounced, &known, NULL, b));
    for (int k = 0; k < 4; k++) {
        d[k] /= 3.0 * fmax((double)r->task->count, 1.0);
        b[k] /= 3.0 * fmax((double)count, 1.0);
    }
    r->mean = d[0] + b[0];
    const double map_mean = r->job->options.light.direct != ALP_DIRECT_OFF ? r->mean : b[3];
    r->scale = alpi_light_scale(r->task, r->mean);
    r->map_scale = alpi_light_scale(r->task, map_mean);
    r->direct_error = r->scale > 0.0 ? sqrt(d[1]) / r->scale : 0.0;
    r->bounced_error = r->map_scale > 0.0 ? sqrt(b[1]) / r->map_scale : 0.0;
    r->bounced_rms = sqrt(b[2]);
    const double solved =
        r->fixed == NULL
            ? alpi_light_solved_error(r->solution, r->mean, r->bounced_rms, r->solved_noise)
            : 0.0;
    r->solved_error = r->map_scale > 0.0 ? solved * r->mean / r->map_scale : 0.0;
    r->map = (alpi_light_error){.over_scale = {(double)NAN, (double)NAN}};
    return ALP_OK;
}

double alpi_light_round_solved_share(const alpi_light_round_state *r)
{
    return r->bounced_rms > 0.0 ? r->solved_error * r->map_scale / r->bounced_rms : 0.0;
}

alp_result alpi_light_round_look(alpi_light_round_state *r)
{
    const alpi_light_task *t = r->task;
    ALP_TRY(alpi_light_peek(r->job, t, r->solution, (const float(*)[3])r->skies,
                            alpi_light_round_solved_share(r), r->fresh));
    return alpi_light_find_error(r->job->context, r->fresh, t, &r->map);
}

// --- what comes next -----------------------------------------------------------------------------

/// What the next round goes for: what the solution leaves of the error that is wanted, which no
/// rays make better, and half of that error where it leaves less; else 2^−½ of what there is.
static double aim_of(const alpi_light_round_state *r)
{
    const double wanted = (double)r->job->options.light.error;
    const double left = wanted * wanted - r->solved_error * r->solved_error;
    return wanted > 0.0 ? sqrt(fmax(left, 0.25 * wanted * wanted))
                        : sqrt(0.5) * hypot(r->direct_error, r->bounced_error);
}

/// Rays of a texel that sends any in this round, weighed by what it has of their squared error.
static double typical_rays(const alpi_light_round_state *r)
{
    double sum = 0.0, weighed = 0.0;
    for (uint32_t i = 0; i < r->worst.count; i++) {
        const uint32_t t = r->worst.list[i];
        const alpi_reference_value *v = &r->task->values[t];
        const double variance =
            (double)v->variance[0] + (double)v->variance[1] + (double)v->variance[2];
        sum += variance;
        weighed += variance * r->rays_of[t];
    }
    return sum > 0.0 ? weighed / sum : r->rays;
}

static alpi_light_plan cheapest(const alpi_light_round_state *r, const alpi_light_noise *noise,
                                double aim)
{
    const alpi_light_effort effort = {.direct = alpi_light_typical_samples(&r->direct),
                                      .rays = typical_rays(r),
                                      .most = alpi_light_round_most_rays(&r->job->options.light),
                                      .texels = r->task->count,
                                      .direct_power = r->direct.power,
                                      .rays_power = r->rays_power,
                                      .draw = fmax(r->solution->direct_draw, 1.0),
                                      .traced = r->worst.count > 0 ? r->worst.count : r->sending};
    return alpi_light_cheapest(&effort, noise, aim);
}

/// Where the map as a whole is good enough, its worst texels may not be yet: they are few, and get
/// samples and rays alone.
static alp_result plan_for_worst(alpi_light_round_state *r, alpi_light_plan *p)
{
    const double limit = ALPI_P99_LIMIT * (double)r->job->options.light.error;
    *p = (alpi_light_plan){0};
    ALP_TRY(alpi_light_round_look(r));
    if (!(r->map.over_scale.p99 > limit)) { // also where it is dark
        return ALP_OK;
    }
    const bool direct = r->job->options.light.direct != ALP_DIRECT_OFF;
    const alpi_light_whole whole = {.values = r->fresh,
                                    .bounced = r->task->values,
                                    .direct = direct ? r->solution->direct : NULL,
                                    .order = r->task->order,
                                    .count = r->task->count};
    alpi_light_noise noise;
    const double solved = alpi_light_tail(&whole, &r->map, limit, &noise);
    alpi_light_find_worst(&whole, &r->map, r->task->receivers->count, limit, r->between, &r->worst);
    *p = cheapest(r, &noise, sqrt(fmax(limit * limit - solved * solved, 0.25 * limit * limit)));
    return ALP_OK;
}

bool alpi_light_round_plan_all(const alpi_light_round_state *r, alpi_light_plan *p)
{
    const double aim = aim_of(r);
    *p = (alpi_light_plan){0};
    if (!(hypot(r->direct_error, r->bounced_error) > aim)) {
        return false;
    }
    const double half = sqrt(0.5) * aim * r->scale; // about what direct light gets
    const double noisy = fmax(alpi_light_noisy_share(&r->direct, half), LEAST_NOISY);
    const alpi_light_noise noise = {r->direct_error, r->bounced_error, noisy};
    *p = cheapest(r, &noise, aim);
    return true;
}

alp_result alpi_light_round_plan(alpi_light_round_state *r, alpi_light_plan *p)
{
    r->for_worst = false;
    r->worst.count = 0;
    if (alpi_light_round_plan_all(r, p)) {
        return ALP_OK;
    }
    r->for_worst = r->job->options.light.error > 0.0f;
    return r->for_worst ? plan_for_worst(r, p) : ALP_OK;
}
