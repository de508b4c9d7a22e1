// SPDX-License-Identifier: MIT
// The error of interpolation, measured at held-out texels.
#include "maps/radiosity/final_gather_job.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { STREAM_HELD_OUT = 10 };

void alpi_held_out_error(const uint32_t *texels, const alpi_reference_value *found, uint32_t count,
                         const alpi_reference_value *values, float variance[3])
{
    for (int k = 0; k < 3; k++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            const double difference = (double)values[texels[i]].mean[k] - (double)found[i].mean[k];
            sum += difference * difference - (double)found[i].variance[k];
        }
        variance[k] = (float)fmax(sum / fmax((double)count, 1.0), 0.0);
    }
}

alp_result alpi_final_gather_measure_interpolated(alpi_final_gather_job *job, uint32_t interpolated,
                                                  float variance[3])
{
    alp_context *context = job->lattice.context;
    const alpi_gather_job *g = job->options->gather;
    alpi_held_out *held = job->options->held_out;
    if (held != NULL && held->count > 0) {
        memcpy(job->list, held->texels, held->count * sizeof *job->list);
        return alpi_final_gather_measure(job, held->count, job->options->independent, held->values);
    }
    const uint32_t count = alpi_final_gather_choose(job, ALPI_TEXEL_INTERPOLATED, interpolated,
                                                    ALPI_HELD_OUT, STREAM_HELD_OUT);
    alpi_reference_value *found = ALPI_NEW(context, alpi_reference_value, count);
    if (found == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result = alpi_final_gather_measure(job, count, g->gatherer, found);
    if (result == ALP_OK) {
        alpi_held_out_error(job->list, found, count, g->values, variance);
    }
    if (result == ALP_OK && held != NULL) {
        held->count = count;
        memcpy(held->texels, job->list, count * sizeof *held->texels);
        memcpy(held->values, found, count * sizeof *held->values);
    }
    alpi_release(context, found);
    return result;
}
