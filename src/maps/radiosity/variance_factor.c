// SPDX-License-Identifier: MIT
// True variance over that of joined replicates. Check texels are traced twice, by x and by
// independent rays y: E[(x − y)²] = 2 Var x. The ratio to the stated variance corrects all texels.
#include "maps/radiosity/final_gather_job.h"

#include "base/memory.h"

enum { STREAM_CHECKS = 11, CHECK_LIMIT = 512 };

/// Σ (x − y)² / 2 over Σ stated variance, over the channels of the listed texels; 1 if no variance
/// is stated.
static float compare_checks(const alpi_final_gather_job *job, const alpi_reference_value *found,
                            uint32_t count)
{
    double squares = 0.0, stated = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const alpi_reference_value *x = &job->options->gather->values[job->list[i]];
        for (int k = 0; k < 3; k++) {
            const double difference = (double)x->mean[k] - (double)found[i].mean[k];
            squares += 0.5 * difference * difference;
            stated += 0.5 * ((double)x->variance[k] + (double)found[i].variance[k]);
        }
    }
    return stated > 0.0 ? (float)(squares / stated) : 1.0f;
}

static void scale_traced(const alpi_final_gather_job *job)
{
    for (uint32_t i = 0; i < job->options->count; i++) {
        const uint32_t t = job->options->order[i];
        if (job->lattice.states[t] == ALPI_TEXEL_TRACED) {
            alpi_final_gather_scale(job, &job->options->gather->values[t]);
        }
    }
}

alp_result alpi_final_gather_find_factor(alpi_final_gather_job *job, uint32_t traced)
{
    enum { LEAST = 64, SHARE = 8 }; // 64 texels err by a tenth; checks cost an eighth of the rays
    if (traced < LEAST && job->report->factor > 0.0f) {
        job->factor = job->report->factor;
        scale_traced(job);
        return ALP_OK;
    }
    const uint32_t few = traced / SHARE > LEAST ? traced / SHARE : LEAST;
    const uint32_t most = few < CHECK_LIMIT ? few : CHECK_LIMIT;
    const uint32_t count =
        alpi_final_gather_choose(job, ALPI_TEXEL_TRACED, traced, most, STREAM_CHECKS);
    alpi_reference_value *found = ALPI_NEW(job->lattice.context, alpi_reference_value, count);
    if (found == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result =
        alpi_final_gather_measure(job, count, job->options->independent, found);
    if (result == ALP_OK) {
        job->factor = compare_checks(job, found, count);
        job->report->factor = job->factor;
        scale_traced(job);
    }
    alpi_release(job->lattice.context, found);
    return result;
}
