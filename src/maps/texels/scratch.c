// SPDX-License-Identifier: MIT
#include "maps/texels/scratch.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <string.h>

enum { TEXELS_PER_RANGE = 1 << 12 };

typedef struct clear_job {
    alpi_scratch *scratch;
    const uint32_t *order;
} clear_job;

static alp_result clear_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const clear_job *job = user;
    alpi_scratch *s = job->scratch;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        memset(s->sums.open[t], 0, sizeof s->sums.open[t]);
        s->sums.done[t] = 0;
        if (s->sums.vectors != NULL) {
            memset(s->sums.vectors[t], 0, sizeof s->sums.vectors[t]);
        }
        s->marks[t] = 0;
        s->inside[t] = 0;
    }
    return ALP_OK;
}

alp_result alpi_scratch_create(alp_context *context, uint32_t texels, bool vectors,
                               alpi_scratch *scratch)
{
    *scratch = (alpi_scratch){.context = context};
    alp_result result = alpi_occlusion_sums_create(context, texels, vectors, &scratch->sums);
    scratch->marks = ALPI_NEW(context, uint8_t, texels);
    scratch->inside = ALPI_NEW(context, uint16_t, texels);
    if (result != ALP_OK || scratch->marks == NULL || scratch->inside == NULL) {
        alpi_scratch_destroy(scratch);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    return ALP_OK;
}

void alpi_scratch_destroy(alpi_scratch *scratch)
{
    if (scratch->context != NULL) {
        alpi_occlusion_sums_destroy(scratch->context, &scratch->sums);
        alpi_release(scratch->context, scratch->marks);
        alpi_release(scratch->context, scratch->inside);
    }
    *scratch = (alpi_scratch){0};
}

alp_result alpi_scratch_clear(alpi_scratch *scratch, const uint32_t *order, uint32_t order_count,
                              const alpi_task_progress *progress)
{
    clear_job job = {scratch, order};
    scratch->sums.parted = 0;
    return alpi_parallel_for(scratch->context, order_count, TEXELS_PER_RANGE, clear_range, &job,
                             progress);
}
