// SPDX-License-Identifier: MIT
// The job: check → atlas → acceleration structure → occlusion → maps → files.
#include "bake/layers.h"

#include "atlas/choice.h"
#include "base/memory.h"
#include "base/tasks.h"
#include "transport/occlusion/occlusion.h"

#include <string.h>
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
                              .sampling = {.accuracy = ALP_ADAPTIVE_AUTO},
                              .stitch = true};
}

static alp_result check_options(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    if (o->struct_size != sizeof *o) {
        return alpi_fail(job->context, ALP_ERROR_INVALID_ARGUMENT,
                         "bake options are not from _default()");
    }
    if ((int)o->existing_ao < ALP_EXISTING_AO_REPLACE || o->existing_ao > ALP_EXISTING_AO_KEEP) {
        return alpi_fail(job->context, ALP_ERROR_INVALID_ARGUMENT,
                         "bake: unknown choice %d for existing occlusion", (int)o->existing_ao);
    }
    if ((int)o->ao_into < ALP_AO_INTO_SEPARATE || o->ao_into > ALP_AO_INTO_ORM) {
        return alpi_fail(job->context, ALP_ERROR_INVALID_ARGUMENT,
                         "bake: unknown choice %d for where occlusion goes", (int)o->ao_into);
    }
    if (o->ao_into == ALP_AO_INTO_ORM && o->atlas.mode == ALP_ATLAS_VERTEX) {
        return alpi_fail(job->context, ALP_ERROR_INVALID_ARGUMENT,
                         "bake: occlusion at vertices has no map to pack into an image");
    }
    const alp_sampling_options *s = &o->sampling;
    const bool accuracy_is_valid =
        s->accuracy == ALP_ADAPTIVE_AUTO || (s->accuracy >= ALP_ADAPTIVE_OFF && s->accuracy < 1.0f);
    if (!accuracy_is_valid || !(s->error >= 0.0f) || !(s->time_limit >= 0.0)) {
        return alpi_fail(job->context, ALP_ERROR_INVALID_ARGUMENT,
                         "bake: accuracy %g (need [0, 1), or AUTO), error %g or time limit %g s "
                         "(need 0 or more)",
                         (double)s->accuracy, (double)s->error, s->time_limit);
    }
    ALP_TRY(alpi_bake_check_vertex_options(job));
    ALP_TRY(alpi_bake_check_maps(job));
    ALP_TRY(alpi_bake_check_maps_format(job));
    ALP_TRY(alpi_bake_check_light_asset(job));
    ALP_TRY(alpi_bake_check_layers(job));
    ALP_TRY(alpi_occlusion_check(job->scene, &o->occlusion));
    if (job->scene->usable_count == 0) {
        return alpi_fail(
            job->context, ALP_ERROR_INVALID_DATA, "%s: nothing to bake: %s", job->scene->name,
            job->scene->triangle_count == 0 ? "the scene has no triangles"
                                            : "no triangle has area and finite coordinates");
    }
    return ALP_OK;
}

alp_result alpi_bake_begin_stage(alpi_bake_job *job, const char *stage)
{
    job->stage = stage;
    alp_progress progress = {stage, 0, 1, 0.0, -1.0};
    if (job->options.progress != NULL &&
        !job->options.progress(job->options.progress_user, &progress)) {
        return alpi_fail(job->context, ALP_ERROR_CANCELLED, "cancelled");
    }
    return ALP_OK;
}

static alp_result make_atlas(alpi_bake_job *job)
{
    double started = alpi_seconds();
    ALP_TRY(alpi_bake_begin_stage(job, "atlas"));
    alp_atlas_options options = job->options.atlas;
    options.progress = job->options.progress;
    options.progress_user = job->options.progress_user;
    alp_atlas *atlas = NULL;
    const alpi_atlas_choice choice = {job->only, job->originals, alpi_bake_exports(job)};
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

static alp_result run(alpi_bake_job *job)
{
    double started = alpi_seconds();
    ALP_TRY(check_options(job));
    ALP_TRY(alpi_bake_choose(job));
    if (alpi_bake_lights_apart(job)) {
        job->options.maps |= ALP_MAP_DIRECT | ALP_MAP_BOUNCED;
    }
    if (job->options.atlas.mode == ALP_ATLAS_VERTEX) {
        return alpi_bake_vertices(job);
    }
    ALP_TRY(alpi_bake_plan_packing(job));
    ALP_TRY(alpi_bake_plan_layers(job));
    ALP_TRY(alpi_bake_check_outputs(job, 1));
    ALP_TRY(make_atlas(job));
    ALP_TRY(alpi_bake_check_outputs(job, job->report.atlas.pages));
    ALP_TRY(alpi_bake_occlusion(job));
    const double seams_started = alpi_seconds();
    ALP_TRY(alpi_bake_seams(job));
    job->report.seconds_seams = alpi_seconds() - seams_started;
    ALP_TRY(alpi_bake_begin_stage(job, "write"));
    double write_started = alpi_seconds();
    ALP_TRY(alpi_bake_pack_images(job));
    ALP_TRY(alpi_bake_make_light_asset(job));
    ALP_TRY(alpi_bake_write_outputs(job));
    job->report.seconds_write = alpi_seconds() - write_started;
    job->report.seconds_total = alpi_seconds() - started;
    return ALP_OK;
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
    alp_result result = alpi_bake_end_budget(&job, run(&job));
    alpi_set_watch(job.context, former);
    alpi_release(job.context, job.only);
    alpi_release(job.context, job.occluders);
    alpi_release(job.context, job.originals);
    alpi_bake_release_packing(&job);
    alpi_bake_release_light_asset(&job);
    alpi_bake_release_layers(&job);
    if (result != ALP_OK && folder_is_new) {
        rmdir(folder); // only if empty: nothing was written is then true
    }
    if (result == ALP_OK && report != NULL) {
        job.report.scene = alp_scene_get_info(scene);
        job.report.maps = job.options.maps;
        job.report.threads = alp_context_worker_count(job.context);
        job.report.seed = job.options.occlusion.seed;
        job.report.input_hash = scene->input_hash;
        job.report.peak_memory_bytes = alp_context_peak_memory(job.context);
        *report = job.report;
    }
    if (result == ALP_OK && lightmap != NULL) {
        *lightmap = job.lightmap;
    } else {
        alp_lightmap_destroy(job.lightmap);
    }
    return result;
}
