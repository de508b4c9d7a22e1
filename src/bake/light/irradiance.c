// SPDX-License-Identifier: MIT
// Irradiance at the texels of a bake: direct light alone, or all of it, by radiosity or by the
// reference.
#include "bake/gathering.h"
#include "bake/layers.h"
#include "bake/light/light.h"
#include "bake/light/light_error.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "transport/direct/direct.h"
#include "transport/examine.h"
#include "transport/paths/reference.h"

#include <math.h>

enum { TEXELS_PER_RANGE = 4096 };

static bool is_by_hemicubes(const alpi_bake_job *job)
{
    const alp_light_options *o = &job->options.light;
    return o->gather == ALP_GATHER_HEMICUBE && o->bounces > 0;
}

typedef struct take_job {
    alpi_bake_job *job;
    const uint32_t *order;
    const alpi_reference_value *values;
} take_job;

static alp_result take_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const take_job *t = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t texel = t->order[i];
        const alpi_reference_value *v = &t->values[texel];
        for (int k = 0; k < 3; k++) {
            t->job->irradiance[texel][k] = v->mean[k];
            t->job->irradiance_errors[texel][k] = sqrtf(v->variance[k]);
        }
    }
    return ALP_OK;
}

/// Takes means and standard errors of the listed texels, and the stated error of the whole.
static alp_result take_values(alpi_bake_job *job, const alpi_light_task *task)
{
    const uint32_t texels = job->lightmap->texels.count;
    ALPI_TRY_NEW(job->context, job->irradiance, texels);
    ALPI_TRY_NEW(job->context, job->irradiance_errors, texels);
    take_job take = {job, task->order, task->values};
    ALP_TRY(
        alpi_parallel_for(job->context, task->count, TEXELS_PER_RANGE, take_range, &take, NULL));
    alpi_light_error error;
    ALP_TRY(alpi_light_find_error(job->context, task->values, task, &error));
    const bool told = !is_by_hemicubes(job);
    alp_bake_report *r = &job->report;
    r->light_mean = error.mean;
    r->light_scale = error.scale;
    r->light_relative_error = told ? error.over_scale.rms : (double)NAN;
    r->light_p99_error = told ? error.over_scale.p99 : (double)NAN;
    return ALP_OK;
}

typedef struct emission_job {
    const alp_scene *scene;
    const alpi_texels *texels;
    const uint32_t *order;
} emission_job;

static void sum_emission(const void *user, uint32_t begin, uint32_t end,
                         double sums[ALPI_SUM_LIMIT])
{
    const emission_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i], triangle = job->texels->triangles[t];
        const float *b = job->texels->barycentrics[t];
        vec3 c[3];
        alpi_triangle_corners(job->scene, triangle, c);
        const vec3 up = {0.0f, 1.0f, 0.0f};
        const vec3 emission = alpi_surface_emission(job->scene, triangle, b[0], b[1],
                                                    vec3_triangle_normal(c[0], c[1], c[2], up));
        sums[0] += (double)vec3_dot(emission, emission);
    }
}

alp_result alpi_light_find_emission(const alpi_bake_job *job, alpi_light_task *task)
{
    double sums[ALPI_SUM_LIMIT] = {0.0};
    const emission_job emission = {job->scene, &job->lightmap->texels, task->order};
    ALP_TRY(alpi_parallel_sum(job->context, task->count, sum_emission, &emission, NULL, sums));
    task->emitted = ALPI_PI * sqrt(sums[0] / (3.0 * fmax((double)task->count, 1.0)));
    return ALP_OK;
}

/// Light that comes straight from where it is made.
static alp_result gather_direct(alpi_bake_job *job, alpi_light_task *t)
{
    ALPI_TRY_NEW(job->context, t->values, t->receivers->count);
    const alp_bake_options *o = &job->options;
    const alpi_direct_options options = {
        .context = job->context,
        .scene = job->scene,
        .tracer = t->tracer,
        .lighting = t->lighting,
        .filter = {.one_sided = o->occlusion.one_sided},
        .samples = o->light.samples,
        .seed = o->occlusion.seed,
    };
    alpi_direct *direct = NULL;
    alpi_direct_output output = {.values = t->values, .directional = t->directional};
    alpi_layer_arrays *layers = alpi_bake_light_layers(job, false);
    if (layers != NULL) {
        const uint32_t texels = t->receivers->count;
        ALP_TRY(alpi_layer_arrays_reserve(layers, texels, 0, texels));
        output.groups = layers->direct;
        output.part_groups = layers->part_layers;
    }
    ALP_TRY(alpi_direct_create(&options, &direct));
    const alp_result result =
        alpi_direct_irradiance(direct, t->receivers, t->order, t->count, &t->progress, &output);
    alpi_bake_sum_layers(job, t->order, t->count, NULL, true, t->values);
    job->report.light_samples = alpi_direct_samples(direct);
    job->report.rays += output.rays;
    alpi_direct_destroy(direct);
    return result;
}

static alp_result gather_paths(alpi_bake_job *job, alpi_light_task *t)
{
    ALPI_TRY_NEW(job->context, t->values, t->receivers->count);
    const alp_bake_options *o = &job->options;
    const uint32_t limit = ALPI_REFERENCE_BOUNCE_LIMIT;
    const alpi_reference reference = {
        .context = job->context,
        .scene = job->scene,
        .tracer = t->tracer,
        .lighting = t->lighting,
        .filter = {.one_sided = o->occlusion.one_sided},
        .bounces = o->light.bounces < limit ? o->light.bounces : limit,
        .samples = o->light.samples,
        .next_event = true,
        .share = true,
        .seed = o->occlusion.seed,
    };
    ALP_TRY(alpi_reference_irradiance(&reference, t->receivers, t->order, t->count, &t->progress,
                                      t->values));
    job->report.light_samples = alpi_reference_samples(&reference);
    job->report.rays += (uint64_t)t->count * job->report.light_samples;
    return ALP_OK;
}

static alp_result gather(alpi_bake_job *job, alpi_light_task *t)
{
    job->report.light_direct = job->options.light.bounces == 0;
    const bool paths = job->options.light.gather == ALP_GATHER_PATHS;
    alp_result result = job->report.light_direct ? gather_direct(job, t)
                        : paths                  ? gather_paths(job, t)
                                                 : alpi_bake_radiosity(job, t);
    if (result == ALP_OK && (job->report.light_direct || paths)) {
        result = alpi_light_probes(job, NULL); // no radiosity to share
    }
    if (result == ALP_OK) {
        result = take_values(job, t);
    }
    alpi_release(job->context, t->values);
    return result;
}

/// Gathers the light of lamps and sky, until the clock says no.
static alp_result gather_by_clock(alpi_bake_job *job, const alpi_lighting *lighting,
                                  alpi_light_clock *clock)
{
    const alpi_gathering *g = &job->gathering;
    const alpi_object *object = &g->objects.items[0];
    const alpi_trace_filter filter = {.one_sided = job->options.occlusion.one_sided};
    const alpi_receivers receivers = alpi_texels_receivers(&job->lightmap->texels);
    ALP_TRY(alpi_examine_light(g->tracer, filter, job->scene, lighting, alpi_light_clock_goes_on,
                               clock));
    alpi_light_task task = {
        .lighting = lighting,
        .tracer = g->tracer,
        .receivers = &receivers,
        .order = object->valid,
        .count = object->valid_count,
        .lattice = &g->lattice,
        .directional = job->directional,
        .progress = {.callback = alpi_light_clock_goes_on, .user = clock, .stage = clock->stage},
        .clock = clock};
    if (alpi_lighting_emitter_count(lighting) > 0) {
        ALP_TRY(alpi_light_find_emission(job, &task));
    }
    return gather(job, &task);
}

alp_result alpi_bake_light(alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    if (!alpi_bake_wants_light(o)) {
        return ALP_OK;
    }
    const alpi_task_progress progress = {
        .callback = o->progress, .user = o->progress_user, .stage = "light"};
    ALP_TRY(alpi_gathering_open_object(job, &job->gathering.objects.items[0], &progress));
    job->stage = "light";
    alpi_scratch_destroy(&job->gathering.scratch);
    if ((o->maps & ALPI_MAPS_BY_DIRECTION) != 0) {
        ALPI_TRY_NEW(job->context, job->directional, job->lightmap->texels.count);
    }
    alpi_lighting *lighting = NULL;
    ALP_TRY(alpi_lighting_create(job->scene, &o->light.lighting, &lighting));
    alpi_light_clock clock = alpi_light_clock_start(job, &progress);
    const alpi_watch former = alpi_set_watch(
        job->context, (alpi_watch){.callback = alpi_light_clock_goes_on, .user = &clock});
    const alp_result result = gather_by_clock(job, lighting, &clock);
    alpi_set_watch(job->context, former);
    alpi_lighting_destroy(job->context, lighting);
    if (result == ALP_ERROR_CANCELLED && !clock.refused && alpi_light_clock_is_late(&clock)) {
        return alpi_fail(job->context, ALP_ERROR_LIMIT,
                         "the time limit ended before any texel had light; allow more time");
    }
    return result;
}
