// SPDX-License-Identifier: MIT
#include "bake/light/light_solve.h"

#include "bake/light/light_layers.h"
#include "base/memory.h"
#include "base/tasks.h"

static alp_result solve_on_map(alpi_light_bake *light, const alpi_light_gatherers *g,
                               alpi_light_solution *s)
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
    options.layers = alpi_light_start_layers(job, options.direct != options.lighting);
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
static alp_result solve_whole_scene(alpi_light_bake *light, alpi_light_solution *s)
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

alp_result alpi_light_solve(alpi_light_bake *light, const alpi_light_gatherers *gatherers,
                            alpi_light_solution *solution)
{
    const bool whole_scene = light->job->only != NULL;
    alpi_light_clock_part(light->clock, false, 1.0);
    ALP_TRY(whole_scene ? solve_whole_scene(light, solution)
                        : solve_on_map(light, gatherers, solution));
    report_solution(light->job, solution->radiosity);
    alpi_radiosity_trim(solution->radiosity, light->settings.in_rounds && !whole_scene);
    return ALP_OK;
}

void alpi_light_solution_clear(alpi_light_solution *solution)
{
    alpi_radiosity_destroy(&solution->own);
    alpi_solution_destroy(solution->whole_scene);
}
