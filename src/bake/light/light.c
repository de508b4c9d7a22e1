// SPDX-License-Identifier: MIT
// The light of a bake: direct light, plus light that surfaces reflect.
//
// 1. Direct light is sampled at each texel.
// 2. Patches of texels reflect it; each bounce pass moves it on by one bounce.
// 3. The final gather: texels trace rays that read the light of the patches.
// 4. Rounds add samples and rays until the wanted error is stated.
//
// docs/how/light.md has the whole in two pages.
#include "bake/light/light.h"

#include "bake/gathering.h"
#include "bake/light/light_denoise.h"
#include "bake/light/light_error.h"
#include "bake/light/light_layers.h"
#include "bake/light/light_rounds.h"
#include "bake/light/light_samples.h"
#include "bake/settings.h"
#include "base/memory.h"
#include "base/tasks.h"
#include "fields/probes/probes.h"
#include "maps/radiosity/solution.h"
#include "transport/examine.h"
#include "transport/paths/reference.h"

#include <math.h>

enum { TEXELS_PER_RANGE = 4096 };

// --- the solution: direct light, patches, bounce passes ------------------------------------------

/// A radiosity on the atlas of the map; or on an atlas of the whole scene, if some surfaces are
/// baked alone (--only).
typedef struct solved {
    alpi_radiosity own;
    alpi_solution *whole_scene; // or NULL
    alpi_radiosity *radiosity;  // one of the two; NULL: none yet
} solved;

static alp_result solve_on_map(alpi_light_bake *light, const alpi_light_gatherers *g, solved *s)
{
    alpi_bake_job *job = light->job;
    const alp_bake_options *o = &job->options;
    alpi_radiosity_options options = alpi_radiosity_options_default();
    options.context = job->context;
    options.scene = job->scene;
    options.tracer = light->tracer;
    options.lighting = light->sources.gathered;
    options.proximity = job->gathering.validity.proximity;
    options.direct = light->sources.sampled;
    options.direct_scene = g->counted ? &g->dark : NULL;
    options.counted = g->counted ? &g->texels : NULL;
    options.filter = (alpi_trace_filter){.one_sided = o->occlusion.one_sided};
    options.gatherer = &g->patches;
    options.bounces = o->light.bounces;
    options.tolerance = light->settings.tolerance;
    options.ray_limit = light->settings.pass_ray_limit;
    options.direct_samples = light->settings.direct_samples;
    options.directional = light->directional != NULL;
    options.kept_limit = UINT64_MAX;
    options.seed = o->occlusion.seed;
    options.layers = alpi_light_find_layers(job, options.direct != options.lighting);
    ALP_TRY(alpi_radiosity_solve(&options, light->lattice, job->lightmap->atlas, light->order,
                                 light->count, &light->progress, &s->own));
    s->radiosity = &s->own;
    return ALP_OK;
}

/// Replaces the direct light of the solution by that of the map's texels.
static alp_result sample_map(alpi_light_bake *light, alpi_radiosity *r)
{
    alpi_bake_job *job = light->job;
    const uint32_t texels = light->receivers->count;
    alpi_release(job->context, r->direct);
    alpi_release(job->context, r->directional);
    r->direct = NULL;
    r->directional = NULL;
    r->texels = light->receivers;
    r->options.direct_samples = light->settings.direct_samples;
    ALPI_TRY_NEW(job->context, r->direct, texels);
    if (light->directional != NULL) {
        ALPI_TRY_NEW(job->context, r->directional, texels);
    }
    alpi_direct_output output = {.values = r->direct, .directional = r->directional};
    const double began = alpi_seconds();
    ALP_TRY(alpi_radiosity_direct(r, light->order, light->count, r->options.direct_samples,
                                  r->options.seed, &light->progress, &output));
    r->direct_seconds = alpi_seconds() - began;
    r->rays += output.rays;
    return ALP_OK;
}

/// Solves on one page of the map's size, by cosine rays.
static alp_result solve_whole_scene(alpi_light_bake *light, solved *s)
{
    const alp_bake_options *o = &light->job->options;
    alpi_solution_options options = {.scene = light->job->scene,
                                     .tracer = light->tracer,
                                     .lighting = light->lighting,
                                     .atlas = alp_atlas_options_default(),
                                     .one_sided = o->occlusion.one_sided,
                                     .bounces = o->light.bounces,
                                     .tolerance = light->settings.tolerance,
                                     .direct_samples = light->settings.own_direct,
                                     .kept_limit = UINT64_MAX,
                                     .ray_limit = light->settings.pass_ray_limit,
                                     .seed = o->occlusion.seed};
    const uint64_t texels = (uint64_t)o->atlas.size * o->atlas.size;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.atlas.size = o->atlas.size;
    options.patch_rays = alpi_light_choose(light->job, texels, light->count).patch_rays;
    ALP_TRY(alpi_solution_create(&options, light->progress.callback, light->progress.user,
                                 &s->whole_scene));
    s->radiosity = &s->whole_scene->radiosity;
    return sample_map(light, s->radiosity);
}

static void report_solution(alpi_bake_job *job, const alpi_radiosity *solution)
{
    if (solution->missing > 0.0) {
        job->report.light_bounded = true;
        alpi_warn(job->context, "bounces-missing", job->scene->name,
                  "bounces of light ended after %u passes, by the limit of rays of a bake without "
                  "--error: about %.2g %% of the light is missing; --error %g goes on",
                  solution->passes, 100.0 * solution->missing,
                  100.0 * (double)job->options.light.error);
    }
    const alpi_energy *e = &solution->energy;
    alp_bake_report *r = &job->report;
    const uint32_t most = sizeof r->light_changes / sizeof *r->light_changes;
    r->rays += solution->rays;
    r->light_passes = solution->passes;
    r->light_energy = (alp_light_energy){e->known,   e->emitted,     e->absorbed,
                                         e->escaped, e->lost_behind, e->unshot};
    for (uint32_t i = 0; i < solution->passes && i < most; i++) {
        r->light_changes[i] = solution->changes[i];
    }
}

static alp_result solve(alpi_light_bake *light, const alpi_light_gatherers *g, solved *s)
{
    const bool whole_scene = light->job->only != NULL;
    alpi_light_clock_part(light->clock, false, 1.0);
    ALP_TRY(whole_scene ? solve_whole_scene(light, s) : solve_on_map(light, g, s));
    report_solution(light->job, s->radiosity);
    alpi_radiosity_trim(s->radiosity, light->settings.in_rounds && !whole_scene);
    return ALP_OK;
}

// --- the light of the map ------------------------------------------------------------------------

typedef struct parts_job {
    const alpi_light_bake *light;
    const alpi_radiosity *solution;
    const float (*skies)[3];
} parts_job;

/// Keeps direct and bounced light apart, and adds direct light to the light by direction.
static alp_result keep_parts(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const parts_job *p = user;
    const alpi_light_bake *light = p->light;
    const alpi_bake_job *job = light->job;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = light->order[i];
        for (int k = 0; k < 3 && job->direct != NULL; k++) {
            const float sky = p->skies != NULL ? p->skies[t][k] : 0.0f;
            job->direct[t][k] = p->solution->direct[t].mean[k] + sky;
            job->bounced[t][k] = light->values[t].mean[k] - sky;
        }
        if (light->directional != NULL && job->options.light.direct != ALP_DIRECT_OFF) {
            alpi_directional_mix(&light->directional[t], 1.0f, &p->solution->directional[t], 1.0f);
        }
    }
    return ALP_OK;
}

/// Joins direct and bounced light to the light of the map.
static alp_result join(alpi_light_bake *light, const alpi_light_rounds *r)
{
    alpi_bake_job *job = light->job;
    const float(*skies)[3] = (const float(*)[3])r->skies;
    const uint32_t texels = light->receivers->count;
    if (alpi_bake_lights_apart(&job->options)) {
        ALPI_TRY_NEW(job->context, job->direct, texels);
        ALPI_TRY_NEW(job->context, job->bounced, texels);
    }
    parts_job parts = {light, r->solution, skies};
    ALP_TRY(
        alpi_parallel_for(job->context, light->count, TEXELS_PER_RANGE, keep_parts, &parts, NULL));
    ALP_TRY(alpi_light_join(light, r->solution, skies, alpi_light_solved_share(r), light->values));
    alpi_light_sum_layers(light, skies, job->options.light.direct != ALP_DIRECT_OFF);
    return ALP_OK;
}

/// Samples the probes of the bake, if it wants any.
/// @param known NULL: their light is solved apart
static alp_result bake_probes(alpi_bake_job *job, const alpi_surface_light *known)
{
    const alp_bake_options *o = &job->options;
    if ((o->maps & ALP_MAP_PROBES) == 0) {
        return ALP_OK;
    }
    alp_probe_options options = o->probes != NULL ? *o->probes : alp_probe_options_default();
    options.lighting = o->light.lighting;
    options.bounces = o->light.bounces;
    options.one_sided = o->occlusion.one_sided;
    options.layers = false;
    options.seed = o->occlusion.seed;
    options.progress = o->progress;
    options.progress_user = o->progress_user;
    return alpi_probes_bake(job->scene, &options, known, &job->probes);
}

/// Gathers in rounds, takes off noise, and joins both kinds of light.
static alp_result gather(alpi_light_bake *light, alpi_light_rounds *rounds)
{
    ALP_TRY(alpi_light_run_rounds(rounds));
    alpi_light_rounds_trim(rounds);
    if (light->job->options.light.denoise) {
        ALP_TRY(alpi_light_denoise(light, rounds->skies));
    }
    return join(light, rounds);
}

static alp_result run_radiosity(alpi_light_bake *light, alpi_light_gatherers *gatherers, solved *s)
{
    ALP_TRY(alpi_light_gatherers_create(light->job, &light->settings, gatherers));
    ALP_TRY(alpi_light_split_sky(light->job, light->lighting, light->tracer, &light->sources));
    ALP_TRY(solve(light, gatherers, s));
    alpi_light_rounds rounds = {.light = light,
                                .solution = s->radiosity,
                                .fixed = gatherers->texel_cube != NULL ? &gatherers->texels : NULL};
    const alp_result result = gather(light, &rounds);
    alpi_light_rounds_clear(&rounds);
    ALP_TRY(result);
    const alpi_surface_light known = alpi_patches_light(&s->radiosity->patches);
    return bake_probes(light->job, &known);
}

alp_result alpi_light_radiosity(alpi_light_bake *light)
{
    alpi_light_gatherers gatherers;
    solved s = {.radiosity = NULL};
    light->settings = alpi_light_choose(light->job, light->receivers->count, light->count);
    const alp_result result = run_radiosity(light, &gatherers, &s);
    alpi_radiosity_destroy(&s.own);
    alpi_solution_destroy(s.whole_scene);
    alpi_light_sources_clear(light->job->context, &light->sources);
    alpi_light_gatherers_clear(&gatherers);
    return result;
}

/// Traces whole paths from each texel: the reference (--gather paths).
static alp_result trace_paths(alpi_light_bake *light)
{
    alpi_bake_job *job = light->job;
    const alp_bake_options *o = &job->options;
    const uint32_t limit = ALPI_REFERENCE_BOUNCE_LIMIT;
    const alpi_reference reference = {
        .context = job->context,
        .scene = job->scene,
        .tracer = light->tracer,
        .lighting = light->lighting,
        .filter = {.one_sided = o->occlusion.one_sided},
        .bounces = o->light.bounces < limit ? o->light.bounces : limit,
        .samples = o->light.samples,
        .next_event = true,
        .share = true,
        .seed = o->occlusion.seed,
    };
    ALPI_TRY_NEW(job->context, light->values, light->receivers->count);
    ALP_TRY(alpi_reference_irradiance(&reference, light->receivers, light->order, light->count,
                                      &light->progress, light->values));
    job->report.light_samples = alpi_reference_samples(&reference);
    job->report.rays += (uint64_t)light->count * job->report.light_samples;
    return ALP_OK;
}

// --- the stage -----------------------------------------------------------------------------------

static alp_result store_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_light_bake *light = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = light->order[i];
        const alpi_reference_value *v = &light->values[t];
        for (int k = 0; k < 3; k++) {
            light->job->irradiance[t][k] = v->mean[k];
            light->job->irradiance_errors[t][k] = sqrtf(v->variance[k]);
        }
    }
    return ALP_OK;
}

/// Stores irradiance and standard errors, and states the error of the map. Hemicubes state none.
static alp_result store(alpi_light_bake *light)
{
    alpi_bake_job *job = light->job;
    const uint32_t texels = light->receivers->count;
    const alp_light_options *o = &job->options.light;
    const bool stated = o->gather != ALP_GATHER_HEMICUBE || o->bounces == 0;
    alpi_light_error error;
    ALPI_TRY_NEW(job->context, job->irradiance, texels);
    ALPI_TRY_NEW(job->context, job->irradiance_errors, texels);
    ALP_TRY(
        alpi_parallel_for(job->context, light->count, TEXELS_PER_RANGE, store_range, light, NULL));
    ALP_TRY(alpi_light_find_error(light, light->values, &error));
    job->report.light_mean = error.mean;
    job->report.light_scale = error.scale;
    job->report.light_relative_error = stated ? error.over_scale.rms : (double)NAN;
    job->report.light_p99_error = stated ? error.over_scale.p99 : (double)NAN;
    return ALP_OK;
}

static alp_result run(alpi_light_bake *light)
{
    alpi_bake_job *job = light->job;
    const alp_light_options *o = &job->options.light;
    const bool direct = o->bounces == 0, paths = o->gather == ALP_GATHER_PATHS;
    job->report.light_direct = direct;
    ALP_TRY(direct  ? alpi_light_sample_all(light)
            : paths ? trace_paths(light)
                    : alpi_light_radiosity(light));
    if (direct || paths) {
        ALP_TRY(bake_probes(job, NULL));
    }
    return store(light);
}

/// Computes the light of lamps and sky, until the clock ends it.
static alp_result run_by_clock(alpi_bake_job *job, const alpi_lighting *lighting,
                               alpi_light_clock *clock)
{
    const alpi_gathering *g = &job->gathering;
    const alpi_object *object = &g->objects.items[0];
    const alpi_receivers receivers = alpi_texels_receivers(&job->lightmap->texels);
    const alpi_trace_filter filter = {.one_sided = job->options.occlusion.one_sided};
    alpi_light_bake light = {
        .job = job,
        .clock = clock,
        .progress = {.callback = alpi_light_clock_goes_on, .user = clock, .stage = clock->stage},
        .lighting = lighting,
        .tracer = g->tracer,
        .receivers = &receivers,
        .lattice = &g->lattice,
        .order = object->valid,
        .count = object->valid_count,
        .directional = job->directional};
    ALP_TRY(alpi_examine_light(g->tracer, filter, job->scene, lighting, alpi_light_clock_goes_on,
                               clock));
    if (alpi_lighting_emitter_count(lighting) > 0) {
        ALP_TRY(alpi_light_find_emission(&light));
    }
    const alp_result result = run(&light);
    alpi_release(job->context, light.values);
    return result;
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
    const alp_result result = run_by_clock(job, lighting, &clock);
    alpi_set_watch(job->context, former);
    alpi_lighting_destroy(job->context, lighting);
    if (result == ALP_ERROR_CANCELLED && !clock.refused && alpi_light_clock_is_late(&clock)) {
        return alpi_fail(job->context, ALP_ERROR_LIMIT,
                         "the time limit ended before any texel had light; allow more time");
    }
    return result;
}
