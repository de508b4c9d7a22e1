// SPDX-License-Identifier: MIT
// The stage of coloured obscurance: every texel sends as many rays as occlusion took.
#include "bake/bake_stages.h"

#include "bake/gathering.h"
#include "base/memory.h"
#include "base/tiles/tiles.h"
#include "transport/occlusion/obscurance.h"

static alp_result color_object(alpi_bake_job *job, alpi_object *object,
                               const alpi_task_progress *progress)
{
    alpi_gathering *g = &job->gathering;
    ALP_TRY(alpi_gathering_open_object(job, object, progress));
    const alpi_receivers receivers = alpi_texels_receivers(&job->lightmap->texels);
    job->report.rays += (uint64_t)object->valid_count * object->samples;
    ALP_TRY(alpi_scratch_clear(&g->scratch, object->valid, object->valid_count, progress));
    return alpi_obscurance_gather(&g->setup, &receivers, object->valid, object->valid_count,
                                  object->samples, progress, &g->scratch.sums, job->obscurance);
}

alp_result alpi_bake_obscurance(alpi_bake_job *job)
{
    const uint32_t texels = job->lightmap->texels.count;
    if ((job->options.maps & ALP_MAP_OBSCURANCE) == 0) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(job->context, job->obscurance, texels);
    const alpi_object_stage stage = {.name = "obscurance",
                                     .rays = (uint64_t)texels * job->report.ao_samples,
                                     .each = color_object};
    (void)alpi_tiles_set_kind(job->context, ALPI_TILES_SPLIT);
    const alp_result result = alpi_gathering_run(job, &stage);
    (void)alpi_tiles_set_kind(job->context, ALPI_TILES_WHOLE);
    return result;
}
