// SPDX-License-Identifier: MIT
// Rays of the final gather, for lists of texels.
#include "maps/radiosity/final_gather_job.h"

#include "base/random.h"

#include <math.h>

void alpi_final_gather_scale(const alpi_final_gather_job *job, alpi_reference_value *value)
{
    for (int k = 0; k < 3; k++) {
        value->variance[k] *= job->factor;
    }
}

/// Traces `count` texels of job->list. @param gather its outputs are written
static alp_result gather_list(alpi_final_gather_job *job, uint32_t count, alpi_gather_job gather)
{
    gather.list = job->list;
    gather.count = count;
    const double rays = (double)gather.gatherer->packet_count * ALPI_PACKET;
    alpi_task_progress progress = job->progress;
    progress.units_before = (double)job->report->rays;
    progress.units_total = fmax((double)job->expected, (double)job->sent + count) * rays;
    job->report->rays += (uint64_t)(count * rays);
    job->sent += count;
    return alpi_gather_irradiance(&gather, &progress);
}

static alp_result trace_listed(alpi_final_gather_job *job, uint32_t count)
{
    const alpi_gather_job *g = job->options->gather;
    ALP_TRY(gather_list(job, count, *g));
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t t = job->list[i];
        job->lattice.states[t] = ALPI_TEXEL_TRACED;
        job->lattice.values[t] = alpi_reference_level(&g->values[t]);
        alpi_final_gather_scale(job, &g->values[t]);
    }
    return ALP_OK;
}

alp_result alpi_final_gather_trace_marked(alpi_final_gather_job *job)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->options->count; i++) {
        const uint32_t t = job->options->order[i];
        if (job->marked[t] != 0) {
            job->marked[t] = 0;
            job->list[count++] = t;
        }
        if (count == ALPI_FINAL_GATHER_LIST) {
            ALP_TRY(trace_listed(job, count));
            count = 0;
        }
    }
    return trace_listed(job, count);
}

uint32_t alpi_final_gather_choose(const alpi_final_gather_job *job, alpi_texel_state state,
                                  uint32_t count, uint32_t most, uint32_t stream)
{
    uint32_t chosen = 0, seen = 0;
    const double step = fmax((double)count / most, 1.0);
    const float offset = alpi_unit_float(alpi_random_key(count, 0, stream));
    double next = (double)offset * step;
    for (uint32_t i = 0; i < job->options->count && chosen < most; i++) {
        const uint32_t t = job->options->order[i];
        const bool hidden = (job->lattice.texels->flags[t] & ALPI_TEXEL_HIDDEN) != 0;
        if (job->lattice.states[t] == state && !hidden && (double)seen++ >= next) {
            job->list[chosen++] = t;
            next += step;
        }
    }
    return chosen;
}

alp_result alpi_final_gather_measure(alpi_final_gather_job *job, uint32_t count,
                                     const alpi_gatherer *gatherer, alpi_reference_value *found)
{
    alpi_reference_value *values = job->options->gather->values;
    for (uint32_t i = 0; i < count; i++) { // the rays overwrite the map, which is restored below
        found[i] = values[job->list[i]];
    }
    alpi_gather_job own = *job->options->gather;
    own.gatherer = gatherer;
    own.skies = NULL;
    own.directional = NULL;
    const alp_result result = gather_list(job, count, own);
    for (uint32_t i = 0; i < count; i++) {
        const alpi_reference_value kept = found[i];
        found[i] = values[job->list[i]];
        alpi_final_gather_scale(job, &found[i]);
        values[job->list[i]] = kept;
    }
    return result;
}
