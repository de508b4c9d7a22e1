// SPDX-License-Identifier: MIT
// The whole bake: run() names its stages in their order.
#include "bake/bake_checkpoint.h"
#include "bake/bake_memory.h"
#include "bake/bake_stages.h"
#include "bake/check.h"
#include "bake/files/light_units.h"
#include "bake/files/outputs.h"
#include "bake/files/own_files.h"
#include "bake/files/pack_orm.h"
#include "bake/gathering.h"
#include "bake/layer_plan.h"
#include "bake/light/light.h"
#include "bake/settings.h"

#include "base/memory.h"
#include "base/tiles/rank_calls.h"
#include "base/tiles/tiles.h"
#include "scene/sides.h"

#include <unistd.h>

alp_bake_options alp_bake_options_default(void)
{
    return (alp_bake_options){.struct_size = sizeof(alp_bake_options),
                              .atlas = alp_atlas_options_default(),
                              .occlusion = alp_occlusion_options_default(),
                              .light = {.lighting = alp_lighting_options_default(),
                                        .bounces = ALP_BOUNCES_CONVERGE,
                                        .samples = 256,
                                        .hemicube = 64},
                              .maps = ALP_MAP_AO,
                              .checkpoint = alp_checkpoint_options_default(),
                              .sampling = {.accuracy = ALP_ADAPTIVE_AUTO},
                              .stitch = true};
}

/// Solids that are wound inwards and hold a lamp of the options are rooms.
static alp_result choose_sides(const alpi_bake_job *job)
{
    const alp_lighting_options *o = &job->options.light.lighting;
    const uint32_t count = alpi_bake_wants_light(&job->options) ? o->lamp_count : 0;
    vec3 *lamps = ALPI_NEW(job->context, vec3, count);
    if (lamps == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < count; i++) {
        lamps[i] = vec3_load(o->lamps[i].position);
    }
    alpi_sides_choose(job->scene, lamps, count);
    alpi_release(job->context, lamps);
    return ALP_OK;
}

static alp_result run(alpi_bake_job *job)
{
    ALP_TRY(alpi_bake_check(job));
    ALP_TRY(alpi_bake_check_lit(job));
    ALP_TRY(choose_sides(job));
    ALP_TRY(alpi_bake_begin_ranks(job));
    ALP_TRY(alpi_bake_open_checkpoint(job));
    ALP_TRY(alpi_bake_choose(job));
    if (job->options.atlas.mode == ALP_ATLAS_VERTEX) {
        return alpi_bake_vertices(job);
    }
    ALP_TRY(alpi_bake_atlas(job));
    ALP_TRY(alpi_bake_receivers(job));
    ALP_TRY(alpi_bake_occlusion(job));
    ALP_TRY(alpi_bake_obscurance(job));
    ALP_TRY(alpi_bake_light(job));
    bool ends = false;
    ALP_TRY(alpi_bake_end_shard(job, &ends));
    if (ends) {
        return ALP_OK;
    }
    ALP_TRY(alpi_bake_store(job));
    ALP_TRY(alpi_bake_stitch(job));
    return alpi_bake_write(job);
}

static void release(alpi_bake_job *job)
{
    alpi_gathering_close(job);
    alpi_release(job->context, job->only);
    alpi_release(job->context, job->occluders);
    alpi_release(job->context, job->originals);
    alpi_bake_release_packing(job);
    alpi_bake_release_light_asset(job);
    alpi_bake_release_layers(job);
    alp_probes_destroy(job->probes);
}

static void finish_report(alpi_bake_job *job, double started)
{
    alp_bake_report *r = &job->report;
    r->scene = alp_scene_get_info(job->scene);
    r->maps = job->options.maps;
    const alpi_tiles *tiles = alpi_context_tiles(job->context);
    r->tiles_run = tiles->ran;
    r->tiles_read = tiles->read;
    r->resumed = tiles->read > 0 && !tiles->merging && alpi_context_ranks(job->context) == NULL;
    r->threads = alp_context_worker_count(job->context);
    r->seed = job->options.occlusion.seed;
    r->input_hash = job->scene->input_hash;
    r->peak_memory_bytes = alp_context_peak_memory(job->context);
    r->seconds_total = alpi_seconds() - started;
    if (r->shard_done && r->seconds_total > 0.0) {
        r->shard_repeated_share = 1.0 - tiles->split_seconds / r->seconds_total;
    }
}

alp_result alp_bake(const alp_scene *scene, const alp_bake_options *options,
                    alp_lightmap **lightmap, alp_bake_report *report)
{
    if (lightmap != NULL) {
        *lightmap = NULL;
    }
    if (scene == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    alpi_bake_job job = {.scene = scene,
                         .context = scene->context,
                         .options = options ? *options : alp_bake_options_default(),
                         .stage = "atlas"};
    alpi_bake_begin_budget(&job);
    alpi_watch former =
        alpi_set_watch(job.context, (alpi_watch){.callback = job.options.progress,
                                                 .user = job.options.progress_user});
    const char *folder = job.options.maps_folder;
    bool folder_is_new = folder != NULL && access(folder, F_OK) != 0;
    const double started = alpi_seconds();
    alpi_guard guard;
    alp_result result = alpi_bake_guard(&job, &guard);
    result = alpi_bake_end_budget(&job, result == ALP_OK ? run(&job) : result);
    result = alpi_ranks_end(job.context, result);
    alpi_bake_unguard(&job, &guard);
    finish_report(&job, started);
    alpi_bake_close_checkpoint(&job, result == ALP_OK);
    alpi_set_watch(job.context, former);
    release(&job);
    if (result != ALP_OK && folder_is_new && alpi_ranks_write(job.context)) {
        rmdir(folder); // only if empty: nothing was written is then true
    }
    if (result == ALP_OK && report != NULL) {
        *report = job.report;
    }
    if (result == ALP_OK && lightmap != NULL) {
        *lightmap = job.lightmap;
    } else {
        alp_lightmap_destroy(job.lightmap);
    }
    return result;
}
