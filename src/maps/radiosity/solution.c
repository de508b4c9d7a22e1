// SPDX-License-Identifier: MIT
#include "maps/radiosity/solution.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "scene/scene.h"

static alp_result make_texels(const alpi_solution_options *o, alp_progress_fn *progress,
                              void *progress_user, alpi_solution *s)
{
    alp_atlas_options atlas = o->atlas;
    atlas.progress = progress;
    atlas.progress_user = progress_user;
    ALP_TRY(alp_atlas_create(o->scene, &atlas, &s->atlas));
    ALP_TRY(alpi_texels_create(s->atlas, &s->texels));
    return alpi_lattice_create(s->atlas, &s->texels, &s->lattice);
}

/// Lists the texels with light of their own, as a bake does. Texels completely inside a solid would
/// be black; they show their neighbours' light.
static alp_result list_texels(const alpi_solution_options *o, const alpi_task_progress *progress,
                              alpi_solution *s)
{
    alp_occlusion_options occlusion = alp_occlusion_options_default();
    occlusion.one_sided = o->one_sided;
    occlusion.seed = o->seed;
    alpi_occlusion_setup setup;
    ALPI_TRY_NEW(s->context, s->order, s->texels.count);
    ALP_TRY(alpi_occlusion_prepare(o->scene, o->tracer, &occlusion, &setup));
    const alpi_receivers receivers = alpi_texels_receivers(&s->texels);
    const alp_result result =
        alpi_validity_create(&setup, &receivers, &s->texels, &s->lattice, s->lattice.order,
                             s->texels.count, progress, &s->validity);
    alpi_occlusion_release(&setup);
    for (uint32_t i = 0; i < s->texels.count && result == ALP_OK; i++) {
        const uint32_t texel = s->lattice.order[i];
        if (!s->validity.dropped[texel]) {
            s->order[s->count++] = texel;
        }
    }
    return result;
}

static alp_result solve(const alpi_solution_options *o, const alpi_task_progress *progress,
                        alpi_solution *s)
{
    s->rays = (alpi_cosine_rays){.context = s->context,
                                 .samples = o->patch_rays > 0 ? o->patch_rays
                                                              : 4 * ALPI_RADIOSITY_PATCH_RAYS,
                                 .replicates = 1,
                                 .seed = o->seed};
    s->gatherer = alpi_cosine_rays_gatherer(&s->rays);
    alpi_radiosity_options options = alpi_radiosity_options_default();
    options.proximity = s->validity.proximity;
    options.context = s->context;
    options.scene = o->scene;
    options.tracer = o->tracer;
    options.lighting = o->lighting;
    options.direct = o->lighting;
    options.filter = (alpi_trace_filter){.one_sided = o->one_sided};
    options.gatherer = &s->gatherer;
    options.kept_limit = o->kept_limit > 0 ? o->kept_limit : options.kept_limit;
    options.direct_samples = o->direct_samples > 0 ? o->direct_samples : options.direct_samples;
    options.bounces = o->bounces;
    options.ray_limit = o->ray_limit;
    options.layers = o->layers;
    options.tolerance = o->tolerance;
    options.backs = true;
    options.seed = o->seed;
    return alpi_radiosity_solve(&options, &s->lattice, s->atlas, s->order, s->count, progress,
                                &s->radiosity);
}

static alp_result create(const alpi_solution_options *o, alp_progress_fn *callback, void *user,
                         alpi_solution *s)
{
    alpi_task_progress progress = {.callback = callback, .user = user, .stage = "validity"};
    ALP_TRY(make_texels(o, callback, user, s));
    ALP_TRY(list_texels(o, &progress, s));
    progress.stage = "light";
    return solve(o, &progress, s);
}

alp_result alpi_solution_create(const alpi_solution_options *options, alp_progress_fn *progress,
                                void *progress_user, alpi_solution **solution)
{
    *solution = NULL;
    alp_context *context = options->scene->context;
    alpi_solution *s = ALPI_NEW(context, alpi_solution, 1);
    if (s == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    s->context = context;
    const alpi_watch former =
        alpi_set_watch(context, (alpi_watch){.callback = progress, .user = progress_user});
    const alp_result result = create(options, progress, progress_user, s);
    alpi_set_watch(context, former);
    if (result != ALP_OK) {
        alpi_solution_destroy(s);
        return result;
    }
    *solution = s;
    return ALP_OK;
}

void alpi_solution_destroy(alpi_solution *solution)
{
    if (solution == NULL) {
        return;
    }
    alp_context *context = solution->context;
    alpi_radiosity_destroy(&solution->radiosity);
    alpi_release(context, solution->order);
    alpi_validity_destroy(&solution->validity);
    alpi_lattice_destroy(&solution->lattice);
    alpi_texels_destroy(context, &solution->texels);
    alp_atlas_destroy(solution->atlas);
    alpi_release(context, solution);
}

alpi_surface_light alpi_solution_light(const alpi_solution *solution)
{
    return alpi_patches_light(&solution->radiosity.patches);
}
