// SPDX-License-Identifier: MIT
#include "maps/texels/pooled_variance.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <string.h>

enum { TEXELS_PER_RANGE = 1 << 10 };

typedef struct pool_job {
    const alpi_lattice *lattice;
    alpi_reference_value *values;
    float (*pooled)[3]; // [texels]
} pool_job;

static alp_result pool_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const pool_job *job = user;
    for (uint32_t t = begin; t < end; t++) {
        uint32_t around[ALPI_NEIGHBOUR_LIMIT + 1], count = 0;
        if (job->lattice->states[t] == ALPI_TEXEL_TRACED) {
            count = alpi_lattice_traced_around(job->lattice, t, around);
            around[count++] = t;
        }
        for (int k = 0; k < 3 && count > 0; k++) {
            float sum = 0.0f;
            for (uint32_t n = 0; n < count; n++) {
                sum += job->values[around[n]].variance[k];
            }
            job->pooled[t][k] = sum / (float)count;
        }
    }
    return ALP_OK;
}

static alp_result store_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const pool_job *job = user;
    for (uint32_t t = begin; t < end; t++) {
        if (job->lattice->states[t] == ALPI_TEXEL_TRACED) {
            memcpy(job->values[t].variance, job->pooled[t], sizeof *job->pooled);
        }
    }
    return ALP_OK;
}

alp_result alpi_pool_variances(const alpi_lattice *lattice, alpi_reference_value *values)
{
    alp_context *context = lattice->context;
    const uint32_t texels = lattice->texels->count;
    pool_job job = {.lattice = lattice, .values = values};
    ALPI_TRY_NEW(context, job.pooled, texels);
    alp_result result =
        alpi_parallel_for(context, texels, TEXELS_PER_RANGE, pool_range, &job, NULL);
    if (result == ALP_OK) {
        result = alpi_parallel_for(context, texels, TEXELS_PER_RANGE, store_range, &job, NULL);
    }
    alpi_release(context, job.pooled);
    return result;
}
