// SPDX-License-Identifier: MIT
#include "maps/occlusion_map.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TEXELS_PER_RANGE = 1 << 12, FLOOD_ROUNDS = 4 };

typedef struct map_job {
    const alpi_occlusion_setup *setup;
    const alpi_receivers *receivers;
    const uint32_t *order;
    uint32_t order_count;
    const alpi_occlusion_map_options *options;
    alpi_lattice *lattice;
    alpi_occlusion_sums sums;
    alpi_occlusion_map_report *report;
    uint8_t *wanted;  // [texels] to be traced next
    uint32_t *list;   // [order_count]
    uint32_t samples; // of this round
    float noise;      // standard deviation of a traced texel, about
    float limit;      // of the pass that runs
    uint32_t pass;
    bool flood;
} map_job;

// --- tracing -------------------------------------------------------------------------------------

/// Traces the texels that are wanted.
static alp_result trace_wanted(map_job *job)
{
    alpi_lattice *l = job->lattice;
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->order_count; i++) {
        const uint32_t t = job->order[i];
        if (job->wanted[t]) {
            job->wanted[t] = 0;
            job->list[count++] = t;
        }
    }
    const alpi_task_progress progress = {.callback = job->options->progress,
                                         .user = job->options->progress_user,
                                         .stage = "occlusion"};
    ALP_TRY(alpi_occlusion_add(job->setup, job->receivers, job->list, count, 0, job->samples,
                               job->samples, &progress, &job->sums));
    for (uint32_t i = 0; i < count; i++) {
        l->states[job->list[i]] = ALPI_TEXEL_TRACED;
        l->values[job->list[i]] = alpi_occlusion_value(&job->sums, job->list[i]);
    }
    job->report->rays += (uint64_t)count * job->samples;
    job->report->traced += count;
    return ALP_OK;
}

/// Mean variance of the traced texels by the spread of their quarters, as if those were independent.
static double spread_variance(const map_job *job)
{
    double sum = 0.0;
    uint64_t count = 0;
    for (uint32_t i = 0; i < job->order_count; i++) {
        const uint32_t t = job->order[i];
        if (job->lattice->states[t] == ALPI_TEXEL_TRACED) {
            const uint32_t *open = job->sums.open[t];
            double mean = 0.0, squares = 0.0;
            for (int q = 0; q < ALPI_QUARTERS; q++) {
                mean += (double)open[q] / ALPI_QUARTERS;
            }
            for (int q = 0; q < ALPI_QUARTERS; q++) {
                squares += ((double)open[q] - mean) * ((double)open[q] - mean);
            }
            const double size = (double)job->sums.done[t] / ALPI_QUARTERS;
            sum += squares / (ALPI_QUARTERS - 1) / ALPI_QUARTERS / (size * size);
            count++;
        }
    }
    return count > 0 ? sum / (double)count : 0.0;
}

// --- passes --------------------------------------------------------------------------------------

static alp_result judge_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    map_job *job = user;
    alpi_lattice *l = job->lattice;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        if (l->states[t] == ALPI_TEXEL_TRACED) {
            continue;
        }
        if (job->flood) {
            job->wanted[t] = alpi_lattice_step(l, t) > job->limit;
            continue;
        }
        if (alpi_lattice_pass(l->texels->pixels[t]) != job->pass) {
            continue;
        }
        alpi_stencil stencil;
        if (alpi_lattice_stencil(l, t, &stencil) && stencil.spread <= job->limit) {
            l->states[t] = ALPI_TEXEL_INTERPOLATED;
            l->values[t] = alpi_lattice_interpolate(l, &stencil);
        } else {
            job->wanted[t] = 1;
        }
    }
    return ALP_OK;
}

static alp_result judge(map_job *job, uint32_t pass, bool flood, float limit)
{
    job->pass = pass;
    job->flood = flood;
    job->limit = limit;
    const alpi_task_progress progress = {.callback = job->options->progress,
                                         .user = job->options->progress_user,
                                         .stage = "occlusion"};
    (void)progress;
    ALP_TRY(alpi_parallel_for(job->setup->context, job->order_count, TEXELS_PER_RANGE, judge_range,
                              job, NULL));
    return trace_wanted(job);
}

float alpi_k4 = 4, alpi_k2 = 4, alpi_kf = 4, alpi_near = 0;
int alpi_nn = 8;
static alp_result run_near(map_job *job)
{
    alpi_occlusion_setup near = *job->setup;
    const alpi_texels *t = job->lattice->texels;
    double area = 0, cover = 0;
    for (uint32_t i = 0; i < t->count; i++) {
        area += t->areas[i];
        cover += t->coverages[i];
    }
    near.distance = (float)(alpi_near * sqrt(area / cover));
    near.falloff = ALP_FALLOFF_NONE;
    near.shift_mask = UINT32_MAX;
    alpi_occlusion_sums sums;
    ALP_TRY(alpi_occlusion_sums_create(job->setup->context, job->receivers->count, false, &sums));
    alp_result result = alpi_occlusion_add(&near, job->receivers, job->order, job->order_count, 0, (uint32_t)alpi_nn, (uint32_t)alpi_nn, NULL, &sums);
    for (uint32_t i = 0; i < job->order_count; i++) {
        const uint32_t k = job->order[i];
        if (alpi_occlusion_value(&sums, k) < 1.0f) {
            job->wanted[k] = 1;
        }
    }
    alpi_occlusion_sums_destroy(job->setup->context, &sums);
    return result;
}

static alp_result run_lattice(map_job *job)
{
    if (alpi_near > 0) {
        ALP_TRY(run_near(job));
    }
    ALP_TRY(judge(job, 0, false, 0.0f));
    job->noise = (float)sqrt(spread_variance(job));
    for (uint32_t pass = 1; pass < ALPI_LATTICE_PASSES; pass++) {
        ALP_TRY(judge(job, pass, false, job->noise * (pass <= 2 ? alpi_k4 : alpi_k2)));
    }
    for (int round = 0; round < FLOOD_ROUNDS; round++) {
        ALP_TRY(judge(job, 0, true, job->noise * alpi_kf));
    }
    return ALP_OK;
}

static alp_result run_all(map_job *job)
{
    for (uint32_t i = 0; i < job->order_count; i++) {
        job->wanted[job->order[i]] = 1;
    }
    return trace_wanted(job);
}

alp_result alpi_occlusion_map(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              const uint32_t *order, uint32_t order_count,
                              const alpi_occlusion_map_options *options, alpi_lattice *lattice,
                              float *errors, alpi_occlusion_map_report *report)
{
    alp_context *context = setup->context;
    *report = (alpi_occlusion_map_report){0};
    map_job job = {.setup = setup,
                   .receivers = receivers,
                   .order = order,
                   .order_count = order_count,
                   .options = options,
                   .lattice = lattice,
                   .report = report,
                   .samples = setup->samples};
    (void)errors;
    alp_result result = alpi_occlusion_sums_create(context, receivers->count, false, &job.sums);
    job.wanted = ALPI_NEW(context, uint8_t, receivers->count);
    job.list = ALPI_NEW(context, uint32_t, order_count);
    if (result == ALP_OK && (job.wanted == NULL || job.list == NULL)) {
        result = ALP_ERROR_OUT_OF_MEMORY;
    }
    if (result == ALP_OK) {
        result = options->accuracy == 0.0f ? run_all(&job) : run_lattice(&job);
    }
    report->interpolated = order_count - report->traced;
    alpi_occlusion_sums_destroy(context, &job.sums);
    alpi_release(context, job.wanted);
    alpi_release(context, job.list);
    return result;
}
