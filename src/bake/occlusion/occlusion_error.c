// SPDX-License-Identifier: MIT
// The stated error after a round. The quarters of a texel's samples give its variance up to a
// factor. The held-out texels measure the factor, apart for traced and for interpolated texels.
#include "bake/occlusion/occlusion_error.h"

#include "maps/texels/relative_error.h"

#include <assert.h>
#include <math.h>

enum { LEAST_HELD_OUT = 512, MOST_HELD_OUT = 8192, TRACED_PER_HELD_OUT = 16 };
// Fewer held-out texels in a state take the usual factor.
enum { STATES = ALPI_TEXEL_INTERPOLATED + 1, LEAST_FOR_FACTOR = 16 };
static const double USUAL_FACTOR = 0.3;

/// Variance of the mean of a texel's quarters, as if they were independent. It is too large by a
/// factor that is about the same for all texels.
static double spread_variance(const alpi_occlusion_sums *sums, uint32_t texel)
{
    const uint32_t *open = sums->open[texel];
    double mean = 0.0, squares = 0.0;
    for (int q = 0; q < ALPI_QUARTERS; q++) {
        mean += (double)open[q] / ALPI_QUARTERS;
    }
    for (int q = 0; q < ALPI_QUARTERS; q++) {
        squares += ((double)open[q] - mean) * ((double)open[q] - mean);
    }
    const double size = (double)sums->done[texel] / ALPI_QUARTERS;
    return size > 0.0 ? squares / ((ALPI_QUARTERS - 1) * ALPI_QUARTERS) / (size * size) : 0.0;
}

// --- noise of the map ----------------------------------------------------------------------------

static void sum_noise(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const alpi_occlusion_state *state = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = state->task->order[i];
        if (state->task->lattice->states[t] == ALPI_TEXEL_TRACED) {
            sums[0] += spread_variance(&state->scratch->sums, t);
            sums[1] += 1.0;
        }
    }
}

alp_result alpi_occlusion_measure_noise(alpi_occlusion_state *state, float *noise, uint32_t *traced)
{
    double sums[ALPI_SUM_LIMIT];
    ALP_TRY(alpi_occlusion_sum_texels(&state->clock, sum_noise, state, sums));
    *noise = sums[1] > 0.0 ? (float)sqrt(sums[0] / sums[1]) : 0.0f;
    *traced = (uint32_t)sums[1];
    return ALP_OK;
}

// --- variances up to the factor ------------------------------------------------------------------

typedef struct error_job {
    const alpi_occlusion_state *state;
    const alpi_lattice *lattice;
    float *errors;          // of the task: variances at first
    double means[STATES];   // of the variances, by state
    double factors[STATES]; // by state
} error_job;

/// Variance of a traced texel, with the traced texels around it. Alone it has 3 degrees of freedom,
/// together about 20.
static double pool_variance(const error_job *job, uint32_t texel)
{
    const alpi_occlusion_sums *sums = &job->state->scratch->sums;
    uint32_t around[ALPI_NEIGHBOUR_LIMIT];
    const uint32_t count = alpi_lattice_traced_around(job->lattice, texel, around);
    double sum = spread_variance(sums, texel);
    for (uint32_t i = 0; i < count; i++) {
        sum += spread_variance(sums, around[i]);
    }
    return sum / (1.0 + count);
}

/// Variance of an interpolated texel: that of its neighbours by their weights, and an allowance for
/// a truth that bends between them.
static void set_stencil_variance(void *user, uint32_t texel, const alpi_stencil *s)
{
    const error_job *job = user;
    double variance = 0.0;
    for (uint32_t i = 0; i < s->count; i++) {
        variance += (double)(s->weights[i] * s->weights[i]) * (double)job->errors[s->texels[i]];
    }
    const double bend = (double)s->bend;
    job->errors[texel] = (float)(variance + 0.25 * bend * bend);
}

static alp_result pool_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const error_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->state->task->order[i];
        const bool traced = job->lattice->states[t] == ALPI_TEXEL_TRACED;
        job->errors[t] = traced ? (float)pool_variance(job, t) : 0.0f;
    }
    return ALP_OK;
}

/// Sums of the variances by state, then numbers of texels by state.
static void sum_variances(const void *user, uint32_t begin, uint32_t end,
                          double sums[ALPI_SUM_LIMIT])
{
    const error_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->state->task->order[i];
        const int state = job->lattice->states[t];
        sums[state] += (double)job->errors[t];
        sums[STATES + state] += 1.0;
    }
}

static alp_result measure_means(alpi_occlusion_state *state, error_job *job)
{
    static_assert(2 * STATES <= (int)ALPI_SUM_LIMIT, "two sums for each state");
    double sums[ALPI_SUM_LIMIT];
    ALP_TRY(alpi_occlusion_sum_texels(&state->clock, sum_variances, job, sums));
    for (int s = 0; s < STATES; s++) {
        job->means[s] = sums[STATES + s] > 0.0 ? sums[s] / sums[STATES + s] : 0.0;
    }
    return ALP_OK;
}

/// A variance, moved a part of the way to the mean of its state. Some twenty numbers per texel
/// happen to be equal here and there, and a stated error of nearly 0 is wrong by many times.
static double shrink_variance(const error_job *job, uint32_t texel)
{
    const double mean = job->means[job->lattice->states[texel]];
    return (double)(float)(0.85 * (double)job->errors[texel] + 0.15 * mean);
}

// --- errors of texels ----------------------------------------------------------------------------

/// Σ (x − y₁)(x − y₂) over the held-out texels in a state, over Σ of their variances.
static double find_factor(const error_job *job, alpi_texel_state state)
{
    const alpi_occlusion_held_out *h = &job->state->held_out;
    double squares = 0.0, expected = 0.0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < h->count; i++) {
        const uint32_t t = h->texels[i];
        if (job->lattice->states[t] != state || h->sums[0].done[i] == 0 ||
            h->sums[1].done[i] == 0) {
            continue;
        }
        const double x = (double)job->lattice->values[t];
        squares += (x - (double)alpi_occlusion_value(&h->sums[0], i)) *
                   (x - (double)alpi_occlusion_value(&h->sums[1], i));
        expected += shrink_variance(job, t);
        count++;
    }
    const bool enough = count >= LEAST_FOR_FACTOR && expected > 0.0 && squares > 0.01 * expected;
    return enough ? squares / expected : USUAL_FACTOR;
}

static alp_result take_roots(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const error_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->state->task->order[i];
        const double factor = job->factors[job->lattice->states[t]];
        job->errors[t] = (float)sqrt(factor * shrink_variance(job, t));
    }
    return ALP_OK;
}

static alp_result measure_texels(alpi_occlusion_state *state)
{
    const alpi_occlusion_task *task = state->task;
    const alpi_task_progress progress = alpi_occlusion_progress_of_texels(&state->clock);
    error_job job = {.state = state, .lattice = task->lattice, .errors = task->errors};
    ALP_TRY(alpi_occlusion_for_texels(&state->clock, pool_range, &job));
    ALP_TRY(alpi_lattice_for_stencils(task->lattice, task->order, task->count, set_stencil_variance,
                                      &job, &progress));
    ALP_TRY(measure_means(state, &job));
    for (int s = ALPI_TEXEL_TRACED; s <= ALPI_TEXEL_INTERPOLATED; s++) {
        job.factors[s] = find_factor(&job, (alpi_texel_state)s);
    }
    return alpi_occlusion_for_texels(&state->clock, take_roots, &job);
}

// --- the stated error ----------------------------------------------------------------------------

/// Chooses the held-out texels, in proportion to the traced ones.
static alp_result choose_held_out(alpi_occlusion_state *state)
{
    float noise = 0.0f;
    uint32_t traced = 0;
    ALP_TRY(alpi_occlusion_measure_noise(state, &noise, &traced));
    uint32_t count = traced / TRACED_PER_HELD_OUT;
    count = count < LEAST_HELD_OUT ? LEAST_HELD_OUT : count > MOST_HELD_OUT ? MOST_HELD_OUT : count;
    return alpi_occlusion_held_out_create(state->task, count, &state->deal, &state->held_out);
}

alp_result alpi_occlusion_measure_error(alpi_occlusion_state *state)
{
    if (state->before == 0) {
        ALP_TRY(choose_held_out(state));
    }
    const alpi_occlusion_task *task = state->task;
    alpi_occlusion_report *report = state->report;
    const alpi_task_progress rays = alpi_occlusion_progress_of_rays(&state->clock);
    const alpi_task_progress texels = alpi_occlusion_progress_of_texels(&state->clock);
    const alp_result traced =
        alpi_occlusion_held_out_trace(&state->held_out, state->before, state->samples, &rays);
    report->rays += 2 * (uint64_t)state->held_out.count * (state->samples - state->before);
    if (state->clock.cancelled && !task->keep_partial) {
        return traced;
    }
    alpi_relative_error relative;
    ALP_TRY(measure_texels(state));
    ALP_TRY(alpi_find_relative_error(task->lattice, task->errors, task->order, task->count, &texels,
                                     &relative));
    report->relative = relative.rms;
    report->p99 = relative.p99;
    return traced;
}
