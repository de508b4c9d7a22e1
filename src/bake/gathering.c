// SPDX-License-Identifier: MIT
#include "bake/gathering.h"

#include "bake/objects.h"
#include "bake/settings.h"
#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <string.h>

// --- life ----------------------------------------------------------------------------------------

static void close_object(alpi_gathering *g)
{
    if (g->setup.context != NULL) {
        alpi_occlusion_release(&g->setup);
    }
    alpi_tracer_destroy(g->owned);
    g->setup = (alpi_occlusion_setup){0};
    g->tracer = g->owned = NULL;
    g->open = NULL;
}

alp_result alpi_gathering_open(alpi_bake_job *job)
{
    alpi_gathering *g = &job->gathering;
    const uint32_t texels = job->lightmap->texels.count;
    const bool vectors = (job->options.maps & (ALP_MAP_BENT | ALP_MAP_OBSCURANCE)) != 0;
    g->began = alpi_seconds();
    ALP_TRY(alpi_lattice_create(job->lightmap->atlas, &job->lightmap->texels, &g->lattice));
    ALP_TRY(alpi_objects_create(job, g->lattice.order, &g->objects));
    ALP_TRY(alpi_scratch_create(job->context, texels, vectors, &g->scratch));
    ALP_TRY(alpi_validity_open(job->context, texels, &g->scratch, &g->validity));
    ALPI_TRY_NEW(job->context, g->valid, texels);
    return ALP_OK;
}

void alpi_gathering_end_rays(alpi_bake_job *job)
{
    alpi_gathering *g = &job->gathering;
    close_object(g);
    alpi_validity_destroy(&g->validity);
    alpi_scratch_destroy(&g->scratch);
    if (g->objects.context != NULL) {
        alpi_objects_destroy(&g->objects);
    }
    alpi_release(job->context, g->valid);
    g->valid = NULL;
}

void alpi_gathering_close(alpi_bake_job *job)
{
    void *const values[] = {job->bent,   job->obscurance, job->irradiance, job->irradiance_errors,
                            job->direct, job->bounced,    job->directional};
    alpi_gathering_end_rays(job);
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        alpi_release(job->context, values[i]);
    }
    job->bent = job->obscurance = job->irradiance = job->irradiance_errors = NULL;
    job->direct = job->bounced = NULL;
    job->directional = NULL;
    if (job->gathering.lattice.context != NULL) {
        alpi_lattice_destroy(&job->gathering.lattice);
    }
    job->gathering = (alpi_gathering){0};
}

// --- objects -------------------------------------------------------------------------------------

static alp_result open_object(alpi_bake_job *job, const alpi_object *object,
                              const alpi_task_progress *progress)
{
    alpi_gathering *g = &job->gathering;
    const bool wanted = alpi_bake_wants_occlusion(&job->options);
    const double started = alpi_seconds();
    bool quick = false;
    ALP_TRY(alpi_object_tracer(job, &g->objects, object, progress->callback, progress->user,
                               &g->tracer, &g->owned));
    if (wanted) {
        const double rays = (double)object->texel_count * job->options.occlusion.samples;
        ALP_TRY(alpi_tracer_quicken(g->tracer, rays, progress->callback, progress->user, &quick));
    }
    job->report.seconds_build += alpi_seconds() - started;
    alp_occlusion_options occlusion = job->options.occlusion;
    occlusion.distance = object->distance;
    occlusion.samples = wanted ? occlusion.samples : 1; // else a sequence that nobody reads
    ALP_TRY(alpi_occlusion_prepare(job->scene, g->tracer, &occlusion, &g->setup));
    g->setup.bent = (job->options.maps & ALP_MAP_BENT) != 0;
    alpi_occlusion_be_quick(&g->setup, quick);
    job->report.ao_distance = fmaxf(job->report.ao_distance, g->setup.distance);
    g->open = object;
    return ALP_OK;
}

alp_result alpi_gathering_open_object(alpi_bake_job *job, const alpi_object *object,
                                      const alpi_task_progress *progress)
{
    if (job->gathering.open == object) {
        return ALP_OK;
    }
    close_object(&job->gathering);
    const alp_result result = open_object(job, object, progress);
    if (result != ALP_OK) {
        close_object(&job->gathering);
    }
    return result;
}

double alpi_gathering_deadline(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    const bool shared = alpi_bake_wants_light(o) && alpi_bake_wants_occlusion(o);
    const double time = shared ? 0.5 * o->sampling.time_limit : o->sampling.time_limit;
    return time > 0.0 ? job->gathering.began + time : HUGE_VAL;
}

// --- progress ------------------------------------------------------------------------------------

/// Progress of the objects of one stage, joined.
typedef struct part_progress {
    alp_progress_fn *callback; // NULL: nobody listens
    void *user;
    const char *stage;
    double begin, end;    // of this object, as shares of the whole
    double done;          // reported so far, as a share of the whole: never less
    double started, last; // alpi_seconds() when the stage began, and of the last report
    uint64_t rays;        // of the whole stage
} part_progress;

/// An alp_progress_fn whose user is a part_progress. Progress of other stages, such as building,
/// counts as the begin of the object.
static bool join_progress(void *user, const alp_progress *progress)
{
    part_progress *part = user;
    const double now = alpi_seconds();
    if (part->callback == NULL || now - part->last < 0.05) {
        return true;
    }
    part->last = now;
    double share = 0.0;
    if (progress->total > 0 && strcmp(progress->stage, part->stage) == 0) {
        share = fmin((double)progress->done / (double)progress->total, 1.0);
    }
    const double done = fmax(part->begin + share * (part->end - part->begin), part->done);
    part->done = done; // the work that is left may grow
    const double seconds = now - part->started;
    const alp_progress told = {
        .stage = part->stage,
        .done = (uint64_t)(done * (double)part->rays),
        .total = part->rays,
        .rays_per_second = seconds > 0.0 ? done * (double)part->rays / seconds : 0.0,
        .seconds_left = done > 0.0 ? seconds * (1.0 - done) / done : -1.0,
    };
    return part->callback(part->user, &told);
}

static alp_result run_each(alpi_bake_job *job, const alpi_object_stage *stage, part_progress *part)
{
    alpi_objects *objects = &job->gathering.objects;
    const alpi_task_progress progress = {
        .callback = join_progress, .user = part, .stage = stage->name};
    const double texels = (double)job->lightmap->texels.count;
    for (uint32_t i = 0; i < objects->count; i++) {
        part->begin = part->end;
        part->end += (double)objects->items[i].texel_count / texels;
        ALP_TRY(stage->each(job, &objects->items[i], &progress));
    }
    part->begin = part->end;
    return stage->join != NULL ? stage->join(job, &progress) : ALP_OK;
}

alp_result alpi_gathering_run(alpi_bake_job *job, const alpi_object_stage *stage)
{
    job->stage = stage->name;
    alpi_objects *objects = &job->gathering.objects;
    if (objects->count == 1) {
        const alpi_task_progress progress = {.callback = job->options.progress,
                                             .user = job->options.progress_user,
                                             .stage = stage->name};
        return stage->each(job, &objects->items[0], &progress);
    }
    part_progress part = {.callback = job->options.progress,
                          .user = job->options.progress_user,
                          .stage = stage->name,
                          .started = alpi_seconds(),
                          .rays = stage->rays};
    const alpi_watch former =
        alpi_set_watch(job->context, (alpi_watch){.callback = join_progress, .user = &part});
    const alp_result result = run_each(job, stage, &part);
    alpi_set_watch(job->context, former);
    return result;
}
