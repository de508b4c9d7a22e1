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
#include "bake/light/light_rounds.h"
#include "bake/light/light_samples.h"
#include "bake/light/light_solve.h"
#include "bake/light/light_store.h"
#include "bake/settings.h"
#include "base/memory.h"
#include "base/tiles/tiles.h"
#include "fields/probes/probes.h"
#include "transport/examine.h"
#include "transport/paths/reference.h"

// --- other techniques, and probes ----------------------------------------------------------------

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

/// Samples the probes of the bake, if it wants any. Shards leave them to the merge.
/// @param known NULL: their light is solved apart
static alp_result bake_probes(alpi_bake_job *job, const alpi_surface_light *known)
{
    const alp_bake_options *o = &job->options;
    if ((o->maps & ALP_MAP_PROBES) == 0 || alpi_tiles_are_shards(job->context)) {
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

// --- the algorithm -------------------------------------------------------------------------------

/// Gathers in rounds, filters noise, and joins both kinds of light.
static alp_result gather(alpi_light_bake *light, alpi_light_rounds *rounds)
{
    const alpi_light_settings *s = &light->settings;
    const bool split = !s->in_rounds && !s->adaptive;
    (void)alpi_tiles_set_kind(light->job->context, split ? ALPI_TILES_SPLIT : ALPI_TILES_WHOLE);
    ALP_TRY(alpi_light_run_rounds(rounds));
    alpi_light_rounds_trim(rounds);
    if (light->job->options.light.denoise) {
        ALP_TRY(alpi_light_denoise(light, rounds->skies));
    }
    return alpi_light_finish(light, rounds);
}

static alp_result run_radiosity(alpi_light_bake *light, alpi_light_gatherers *gatherers,
                                alpi_light_solution *solution)
{
    ALP_TRY(alpi_light_gatherers_create(light->job, &light->settings, gatherers));
    ALP_TRY(alpi_light_split_sky(light->job, light->lighting, light->tracer, &light->sources));
    ALP_TRY(alpi_light_solve(light, gatherers, solution));
    alpi_light_rounds rounds = {.light = light,
                                .solution = solution->radiosity,
                                .fixed = gatherers->texel_cube != NULL ? &gatherers->texels : NULL};
    const alp_result result = gather(light, &rounds);
    alpi_light_rounds_clear(&rounds);
    (void)alpi_tiles_set_kind(light->job->context, ALPI_TILES_WHOLE);
    ALP_TRY(result);
    const alpi_surface_light known = alpi_patches_light(&solution->radiosity->patches);
    return bake_probes(light->job, &known);
}

alp_result alpi_light_radiosity(alpi_light_bake *light)
{
    alpi_light_gatherers gatherers;
    alpi_light_solution solution = {.radiosity = NULL};
    light->settings = alpi_light_choose(light->job, light->receivers->count, light->count);
    const alp_result result = run_radiosity(light, &gatherers, &solution);
    alpi_light_solution_clear(&solution);
    alpi_light_sources_clear(light->job->context, &light->sources);
    alpi_light_gatherers_clear(&gatherers);
    return result;
}

// --- the stage -----------------------------------------------------------------------------------

static alp_result run(alpi_light_bake *light)
{
    alpi_bake_job *job = light->job;
    const alp_light_options *o = &job->options.light;
    const bool direct = o->bounces == 0, paths = o->gather == ALP_GATHER_PATHS;
    job->report.light_direct = direct;
    (void)alpi_tiles_set_kind(job->context, direct || paths ? ALPI_TILES_SPLIT : ALPI_TILES_WHOLE);
    ALP_TRY(direct  ? alpi_light_sample_all(light)
            : paths ? trace_paths(light)
                    : alpi_light_radiosity(light));
    (void)alpi_tiles_set_kind(job->context, ALPI_TILES_WHOLE);
    if (direct || paths) {
        ALP_TRY(bake_probes(job, NULL));
    }
    return alpi_light_store(light);
}

/// Light as emission is multiplied by nothing.
static void warn_of_metal(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    if (o->output == NULL || o->maps_folder != NULL || o->lightmap_as != ALP_LIGHTMAP_AS_EMISSIVE) {
        alpi_scene_warn_of_metal(job->scene);
    }
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
    warn_of_metal(job);
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
