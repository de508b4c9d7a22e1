// SPDX-License-Identifier: MIT
#include "maps/radiosity/final_gather.h"

#include "base/memory.h"
#include "maps/radiosity/final_gather_job.h"
#include "maps/texels/pooled_variance.h"
#include "maps/texels/validity.h"

#include <math.h>
#include <string.h>

enum { TEXELS_PER_RANGE = 1 << 9 }; // few, as some texels take longer
enum { FLOOD_ROUNDS = 4 };

// Limits in standard deviations of the noise.
static const float BEND_LIMIT = 1.0f, SPREAD_LIMIT = 20.0f, KINK_LIMIT = 2.0f;
/// Share of the spread near another surface. Half of it and half of the bend, with all texels that
/// touch one traced, took twice the rays on cornell for the same error.
static const float NEAR_SPREAD = 0.3f;

static alp_result for_texels(alpi_final_gather_job *job, alpi_task_fn *body)
{
    alpi_task_progress silent = job->progress;
    silent.silent = true;
    return alpi_parallel_for(job->lattice.context, job->options->count, TEXELS_PER_RANGE, body, job,
                             &silent);
}

static uint32_t count_traced(const alpi_final_gather_job *job)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->options->count; i++) {
        count += job->lattice.states[job->options->order[i]] == ALPI_TEXEL_TRACED;
    }
    return count;
}

// --- noise ---------------------------------------------------------------------------------------

static void sum_noise(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const alpi_final_gather_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->options->order[i];
        const alpi_reference_value *v = &job->options->gather->values[t];
        if (job->lattice.states[t] == ALPI_TEXEL_TRACED) {
            const double mean = (double)alpi_reference_level(v);
            // The errors of the channels are correlated.
            sums[0] +=
                ((double)v->variance[0] + (double)v->variance[1] + (double)v->variance[2]) / 3.0;
            sums[1] += mean;
            sums[2] += mean * mean;
        }
    }
}

static alp_result measure_noise(alpi_final_gather_job *job, uint32_t traced)
{
    double sums[ALPI_SUM_LIMIT] = {0.0};
    ALP_TRY(
        alpi_parallel_sum(job->lattice.context, job->options->count, sum_noise, job, NULL, sums));
    job->noise = sums[2] > 0.0 ? (float)sqrt(sums[0] / sums[2]) : 0.0f;
    job->mean = traced > 0 ? (float)(sums[1] / traced) : 0.0f;
    return ALP_OK;
}

/// The noise at a texel of this light. Half of it scales with the mean over the map, which relaxes
/// the limits in the dark.
static float noise_at(const void *user, float light)
{
    const alpi_final_gather_job *job = user;
    return job->noise * 0.5f * (fmaxf(light, 0.0f) + job->mean);
}

// --- the lattice ---------------------------------------------------------------------------------

static alp_result judge_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    alpi_final_gather_job *job = user;
    const alpi_lattice_judge judge = {.lattice = &job->lattice,
                                      .order = job->options->order,
                                      .proximity = job->options->proximity,
                                      .marked = job->marked,
                                      .spread = SPREAD_LIMIT,
                                      .bend = BEND_LIMIT,
                                      .kink = KINK_LIMIT,
                                      .noise = noise_at,
                                      .near_spread = NEAR_SPREAD,
                                      .near_bend = 1.0f,
                                      .user = job,
                                      .level = job->level,
                                      .flood = job->flood};
    alpi_lattice_judge_range(&judge, begin, end);
    return ALP_OK;
}

/// Marks the texels to be traced first: the lattice, which no stencil covers, and every second
/// texel of every second row where another surface touches. Not adaptive: all.
static alp_result mark_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_final_gather_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->options->order[i];
        const uint16_t *pixel = job->lattice.texels->pixels[t];
        const uint8_t proximity =
            job->options->proximity != NULL ? job->options->proximity[t] : ALPI_FAR;
        job->marked[t] = job->lattice.states[t] == ALPI_TEXEL_OPEN &&
                         (!job->options->adaptive || alpi_lattice_level(pixel) == 0 ||
                          (proximity == ALPI_TOUCHING && alpi_lattice_is_coarse(pixel)));
    }
    return ALP_OK;
}

/// Interpolates the texels of a level that may be, and traces the others.
static alp_result run_level(alpi_final_gather_job *job, uint32_t level)
{
    job->level = level;
    job->flood = false;
    ALP_TRY(for_texels(job, judge_range));
    return alpi_final_gather_trace_marked(job);
}

/// @param traced out: how many texels
static alp_result flood(alpi_final_gather_job *job, uint64_t *traced)
{
    const uint64_t before = job->sent;
    job->flood = true;
    ALP_TRY(for_texels(job, judge_range));
    ALP_TRY(alpi_final_gather_trace_marked(job));
    *traced = job->sent - before;
    return ALP_OK;
}

/// Interpolates all channels, since texels of stencils were traced after the judge saw them.
static void interpolate(void *user, uint32_t texel, const alpi_stencil *stencil)
{
    const alpi_final_gather_job *job = user;
    job->lattice.values[texel] = alpi_lattice_interpolate(&job->lattice, stencil);
    alpi_stencil_light(job->options->gather, texel, stencil);
    alpi_stencil_directional(job->options->gather, texel, stencil);
}

/// Runs the levels of half and quarter spacing, and the flood, after the lattice itself.
static alp_result refine(alpi_final_gather_job *job)
{
    for (uint32_t level = 1; level < ALPI_LATTICE_LEVELS; level++) {
        ALP_TRY(run_level(job, level));
    }
    uint64_t last = 1;
    for (int round = 0; round < FLOOD_ROUNDS && last > 0; round++) {
        ALP_TRY(flood(job, &last));
    }
    alpi_task_progress silent = job->progress;
    silent.silent = true;
    return alpi_lattice_for_stencils(&job->lattice, job->options->order, job->options->count,
                                     interpolate, job, &silent);
}

static alp_result state_errors(alpi_final_gather_job *job)
{
    const uint32_t traced = count_traced(job);
    const uint32_t interpolated = job->options->count - traced;
    float variance[3] = {0.0f, 0.0f, 0.0f};
    job->report->traced = traced;
    job->report->interpolated = interpolated;
    ALP_TRY(alpi_pool_variances(&job->lattice, job->options->gather->values));
    const bool held = job->options->held_out != NULL && job->options->held_out->count > 0;
    if (interpolated > 0 || held) {
        ALP_TRY(alpi_final_gather_measure_interpolated(job, interpolated, variance));
    }
    for (uint32_t i = 0; i < job->options->count; i++) {
        const uint32_t t = job->options->order[i];
        if (job->lattice.states[t] != ALPI_TEXEL_TRACED) {
            memcpy(job->options->gather->values[t].variance, variance, sizeof variance);
        }
    }
    return ALP_OK;
}

// --- the map -------------------------------------------------------------------------------------

/// Hidden texels are black and count as traced. Rays from inside a solid would hit hidden points of
/// texels that show the light of their visible parts.
static void start_texel(const alpi_final_gather_job *job, uint32_t texel)
{
    const bool hidden = (job->lattice.texels->flags[texel] & ALPI_TEXEL_HIDDEN) != 0;
    job->lattice.states[texel] = hidden ? ALPI_TEXEL_TRACED : ALPI_TEXEL_OPEN;
    if (hidden) {
        job->options->gather->values[texel] = (alpi_reference_value){0};
        job->lattice.values[texel] = 0.0f;
    }
}

static alp_result start(alpi_final_gather_job *job)
{
    alp_context *context = job->lattice.context;
    const uint32_t texels = job->lattice.texels->count, count = job->options->count;
    ALPI_TRY_NEW(context, job->marked, texels);
    ALPI_TRY_NEW(context, job->list,
                 count < ALPI_FINAL_GATHER_LIST ? count : ALPI_FINAL_GATHER_LIST);
    if (job->lattice.values == NULL) {
        ALPI_TRY_NEW(context, job->lattice.values, texels);
    }
    for (uint32_t i = 0; i < count; i++) {
        start_texel(job, job->options->order[i]);
    }
    return ALP_OK;
}

static alp_result run(alpi_final_gather_job *job)
{
    ALP_TRY(start(job));
    ALP_TRY(for_texels(job, mark_range));
    ALP_TRY(alpi_final_gather_trace_marked(job));
    const uint32_t traced = count_traced(job);
    if (job->options->joined) {
        ALP_TRY(alpi_final_gather_find_factor(job, traced));
    }
    ALP_TRY(measure_noise(job, traced));
    if (job->options->adaptive) {
        ALP_TRY(refine(job));
    }
    return state_errors(job);
}

alpi_lattice alpi_final_gather_lattice(const alpi_lattice *lattice, uint8_t *states, float *values)
{
    alpi_lattice own = *lattice;
    own.states = states;
    own.values = values;
    own.straight = true;
    return own;
}

alp_result alpi_final_gather(const alpi_final_gather_options *options, const alpi_lattice *lattice,
                             const alpi_task_progress *progress, uint8_t *states,
                             alpi_final_gather_report *report)
{
    const bool first = report->traced == 0 || !options->adaptive;
    alpi_final_gather_job job = {.options = options, .report = report, .factor = 1.0f};
    job.expected = (first ? options->count : report->traced) + ALPI_HELD_OUT;
    *report = (alpi_final_gather_report){.factor = report->factor};
    job.progress = progress != NULL ? *progress : (alpi_task_progress){0};
    job.lattice = alpi_final_gather_lattice(lattice, states, options->means);
    const alp_result result = run(&job);
    alpi_release(lattice->context, job.marked);
    alpi_release(lattice->context, job.list);
    if (options->means == NULL) {
        alpi_release(lattice->context, job.lattice.values);
    }
    return result;
}
