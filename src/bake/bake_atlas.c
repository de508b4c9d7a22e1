// SPDX-License-Identifier: MIT
// The stage of the atlas: charts, pages, texels, and the memory that the rest of the bake takes.
#include "bake/bake_stages.h"

#include "atlas/choice.h"
#include "bake/bake_memory.h"
#include "bake/files/outputs.h"
#include "bake/settings.h"
#include "base/tasks.h"

static alp_result make_atlas(alpi_bake_job *job)
{
    double started = alpi_seconds();
    ALP_TRY(alpi_bake_begin_stage(job, "atlas"));
    alp_atlas_options options = job->options.atlas;
    options.progress = job->options.progress;
    options.progress_user = job->options.progress_user;
    alp_atlas *atlas = NULL;
    const alpi_atlas_choice choice = {job->only, job->originals,
                                      alpi_bake_exports(&job->options, job->scene)};
    ALP_TRY(alpi_atlas_create(job->scene, &options, &choice, &atlas));
    alp_result result = alpi_bake_check_memory(job, &atlas->info);
    if (result != ALP_OK) {
        alp_atlas_destroy(atlas);
        return result;
    }
    ALP_TRY(alpi_lightmap_create(atlas, &job->lightmap));
    job->report.atlas = atlas->info;
    job->report.atlas.texels = job->lightmap->texels.count;
    job->report.seconds_atlas = alpi_seconds() - started;
    return ALP_OK;
}

alp_result alpi_bake_atlas(alpi_bake_job *job)
{
    ALP_TRY(alpi_bake_check_outputs(job, 1));
    ALP_TRY(make_atlas(job));
    return alpi_bake_check_outputs(job, job->report.atlas.pages);
}
