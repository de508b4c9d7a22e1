// SPDX-License-Identifier: MIT
// The radiosity of a bake: solved on blocks of texels, then gathered once more from every texel.
#include "bake/layers.h"
#include "bake/light/light.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/radiosity/counted_emitters.h"
#include "maps/radiosity/radiosity.h"
#include "maps/radiosity/solution.h"
#include "transport/gather/cosine_rays.h"
#include "transport/gather/hemicube.h"

#include <math.h>

enum { BLOCK_CUBE = 16 };

// What the rays of all blocks together miss is a bias of the whole map: measured, at most 1.5 /
// √rays of a bounce; what those of single blocks miss is noise about them, measured, 1.6 / √rays
// percent of the light. Each shall be a quarter of the error that is wanted, or that the samples of
// a texel leave, which is about 16 / √samples percent: of a rms error that is 3 %.
//
// Where the solution is not refined later, direct light that it reflects has noise of its own: with
// 16 samples, measured, 0.4 % of the light about it. It shall be a third of that error.
static const double DIRECT_SHARE = 0.0125; // error at which 16 samples are enough for that

/// The error that is wanted, or about what the samples of a texel leave; 0: there is time for more.
static double find_error(const alp_light_options *o)
{
    enum { MOST_SAMPLES = 65536 };
    return o->error > 0.0f             ? (double)o->error
           : o->samples < MOST_SAMPLES ? 0.16 / sqrt((double)o->samples)
                                       : 0.0;
}

/// A ray through a million triangles takes about three times as long as one through 16,384
/// (`alpenglow bench light`), and a ray that meets masks about twice as long as others.
double alpi_light_ray_limit(const alpi_bake_job *job, uint32_t texels)
{
    static const double RAYS_OF_TEXEL = 1024.0, LEAST_TEXELS = 0x1p17, FEW_TRIANGLES = 0x1p14;
    const alp_scene *scene = job->scene;
    const double triangles = fmax((double)scene->triangle_count, FEW_TRIANGLES);
    bool masks = false;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        masks = masks || (alpi_surface_has_cuts(scene, s) && !alpi_surface_is_pane(scene, s));
    }
    return job->options.light.bounded && job->options.light.error > 0.0f
               ? RAYS_OF_TEXEL * fmax(texels, LEAST_TEXELS) * cbrt(FEW_TRIANGLES / triangles) *
                     (masks ? 0.5 : 1.0)
               : HUGE_VAL;
}

/// Rays of the passes, as many as later rounds may take, shared with the passes of layers.
static double find_pass_limit(const alpi_bake_job *job, uint32_t texels)
{
    const double limit = alpi_light_ray_limit(job, texels);
    return isinf(limit) ? 0.0 : limit / (1.0 + job->layers.light.count);
}

static uint32_t find_direct_samples(const alp_light_options *o)
{
    enum { LEAST = 16, MOST = 1024 };
    const double error = find_error(o);
    const double samples = error > 0.0 ? LEAST * pow(DIRECT_SHARE / error, 2.0) : LEAST;
    return (uint32_t)fmin(fmax(samples, LEAST), MOST);
}

/// What is left out of all light where passes end is a bias, and mostly in a few places: of light
/// that a sphere throws onto a plane, .06 % of the whole left out made .4 % of error. Of a number
/// of bounces by a number of samples nothing is left out: what a light brings hangs on no other
/// light.
static double find_tolerance(const alp_light_options *o)
{
    static const double SHARE = 0.01, LEAST = 5e-5, MOST = 5e-4;
    return o->error > 0.0f || o->bounces > ALPI_RADIOSITY_PASS_LIMIT
               ? fmin(fmax(SHARE * find_error(o), LEAST), MOST)
               : 0.0;
}

uint32_t alpi_light_block_rays(const alp_light_options *options, uint64_t texels)
{
    enum { TEXELS_PER_BLOCK = 5, FEWEST_RAYS = 16, MOST_RAYS = 1024 };
    if (options->gather == ALP_GATHER_HEMICUBE) {
        return 3 * BLOCK_CUBE * BLOCK_CUBE; // a face, and four halves of one
    }
    const double error = find_error(options);
    if (error == 0.0) { // rounds come first
        return ALPI_RADIOSITY_PATCH_RAYS;
    }
    const double all = pow(6.0 / error, 2.0), about = pow(0.064 / error, 2.0);
    const double each = fmax(all * TEXELS_PER_BLOCK / fmax((double)texels, 1.0), about);
    uint32_t rays = FEWEST_RAYS;
    while (rays * sqrt(2.0) < each && rays < MOST_RAYS) { // the nearest power of two
        rays *= 2;
    }
    return rays;
}

/// How blocks gather, and, by hemicubes, how texels do.
typedef struct light_gatherers {
    alpi_cosine_rays block_rays;
    alpi_hemicube *block_cube, *texel_cube; // or NULL
    alpi_hemicube_options block_cubes, texel_cubes;
    alpi_gatherer blocks, texels;
    bool counts;    // emissive surfaces are what hemicubes see of them, and
    alp_scene dark; // direct light is that of the scene without them
} light_gatherers;

static alp_result make_hemicubes(const alpi_bake_job *job, uint64_t seed, light_gatherers *g)
{
    const uint32_t n = job->options.light.hemicube;
    ALP_TRY(alpi_hemicube_create(job->context, n, &g->texel_cube));
    ALP_TRY(alpi_hemicube_create(job->context, n < BLOCK_CUBE ? n : BLOCK_CUBE, &g->block_cube));
    g->texel_cubes = (alpi_hemicube_options){
        .context = job->context, .cube = g->texel_cube, .turned = true, .seed = seed};
    g->block_cubes = g->texel_cubes;
    g->block_cubes.cube = g->block_cube;
    g->block_cubes.scattered = true;
    g->blocks = alpi_hemicube_gatherer(&g->block_cubes);
    g->texels = alpi_hemicube_gatherer(&g->texel_cubes);
    g->counts = job->options.light.emitters == ALP_EMITTERS_COUNTED;
    return g->counts ? alpi_scene_without_emitters(job->scene, &g->dark) : ALP_OK;
}

/// @param texels that there are
static alp_result make_gatherers(const alpi_bake_job *job, uint64_t texels, light_gatherers *g)
{
    const alp_light_options *o = &job->options.light;
    const uint64_t seed = job->options.occlusion.seed;
    *g = (light_gatherers){0};
    if (o->gather == ALP_GATHER_HEMICUBE) {
        return make_hemicubes(job, seed, g);
    }
    g->block_rays = (alpi_cosine_rays){.context = job->context,
                                       .samples = alpi_light_block_rays(o, texels),
                                       .replicates = 1,
                                       .seed = seed};
    g->blocks = alpi_cosine_rays_gatherer(&g->block_rays);
    return ALP_OK;
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

static alp_result gather_light(alpi_bake_job *job, alpi_light_task *t, light_gatherers *g,
                               const alpi_lighting *direct)
{
    const alp_bake_options *o = &job->options;
    alpi_radiosity_options options = alpi_radiosity_options_default();
    options.context = job->context;
    options.scene = job->scene;
    options.tracer = t->tracer;
    options.lighting = t->lighting;
    options.patch_rule.proximity = job->gathering.validity.proximity;
    options.direct = direct;
    options.direct_scene = g->counts ? &g->dark : NULL;
    options.counted = g->counts ? &g->texels : NULL;
    options.filter = (alpi_trace_filter){.one_sided = o->occlusion.one_sided};
    options.gatherer = &g->blocks;
    options.bounces = o->light.bounces;
    options.tolerance = find_tolerance(&o->light);
    options.ray_limit = find_pass_limit(job, t->count);
    options.direct_samples = alpi_light_first_direct(job);
    options.directional = t->directional != NULL;
    options.kept_limit = UINT64_MAX;
    options.seed = o->occlusion.seed;
    options.layers = alpi_bake_light_layers(job, direct != t->lighting);
    alpi_radiosity solution;
    alpi_light_clock_part(t->clock, false, 1.0);
    ALP_TRY(alpi_radiosity_solve(&options, t->lattice, job->lightmap->atlas, t->order, t->count,
                                 &t->progress, &solution));
    report_solution(job, &solution);
    alpi_radiosity_trim(&solution, alpi_light_has_rounds(o));
    alp_result result =
        alpi_light_rounds(job, t, g->texel_cube != NULL ? &g->texels : NULL, &solution);
    if (result == ALP_OK) {
        const alpi_surface_light known = alpi_patches_light(&solution.patches);
        result = alpi_light_probes(job, &known);
    }
    alpi_radiosity_destroy(&solution);
    return result;
}

/// Direct light of the baked texels in place of that of the solution's own.
static alp_result light_texels(alpi_bake_job *job, const alpi_light_task *t, alpi_radiosity *r)
{
    const uint32_t texels = t->receivers->count;
    alpi_release(job->context, r->direct);
    alpi_release(job->context, r->directional);
    r->direct = NULL;
    r->directional = NULL;
    r->texels = t->receivers;
    r->options.direct_samples = alpi_light_first_direct(job);
    ALPI_TRY_NEW(job->context, r->direct, texels);
    if (t->directional != NULL) {
        ALPI_TRY_NEW(job->context, r->directional, texels);
    }
    alpi_direct_output output = {.values = r->direct, .directional = r->directional};
    const double began = alpi_seconds();
    ALP_TRY(alpi_radiosity_direct(r, t->order, t->count, r->options.direct_samples, r->options.seed,
                                  &t->progress, &output));
    r->direct_seconds = alpi_seconds() - began;
    r->rays += output.rays;
    return ALP_OK;
}

/// Where only some surfaces are baked, light comes from all: it is solved for on an atlas of the
/// whole scene, one page of the bake's size, always by cosine rays.
static alp_result gather_around(alpi_bake_job *job, alpi_light_task *t, const light_gatherers *g)
{
    alpi_solution_options options = {.scene = job->scene,
                                     .tracer = t->tracer,
                                     .lighting = t->lighting,
                                     .atlas = alp_atlas_options_default(),
                                     .one_sided = job->options.occlusion.one_sided,
                                     .bounces = job->options.light.bounces,
                                     .tolerance = find_tolerance(&job->options.light),
                                     .seed = job->options.occlusion.seed};
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.atlas.size = job->options.atlas.size;
    options.patch_rays = alpi_light_block_rays(&job->options.light,
                                               (uint64_t)options.atlas.size * options.atlas.size);
    options.direct_samples = find_direct_samples(&job->options.light);
    options.kept_limit = UINT64_MAX;
    options.ray_limit = find_pass_limit(job, t->count);
    alpi_solution *around = NULL;
    alpi_light_clock_part(t->clock, false, 1.0);
    ALP_TRY(alpi_solution_create(&options, t->progress.callback, t->progress.user, &around));
    alp_result result = light_texels(job, t, &around->radiosity);
    if (result == ALP_OK) {
        report_solution(job, &around->radiosity);
        alpi_radiosity_trim(&around->radiosity, false);
        result = alpi_light_rounds(job, t, g->texel_cube != NULL ? &g->texels : NULL,
                                   &around->radiosity);
    }
    if (result == ALP_OK) {
        const alpi_surface_light known = alpi_solution_light(around);
        result = alpi_light_probes(job, &known);
    }
    alpi_solution_destroy(around);
    return result;
}

/// A sky without bright spots is best gathered with what is bounced, by the same rays; the spots
/// are looked for directly, with all else. Panes would mix the two.
static alp_result gather_with_sky(alpi_bake_job *job, alpi_light_task *t, light_gatherers *g)
{
    if (job->only != NULL) {
        return gather_around(job, t, g);
    }
    if (alpi_lighting_sky(t->lighting) == NULL || alpi_tracer_has_panes(t->tracer)) {
        return gather_light(job, t, g, t->lighting);
    }
    alpi_light_task with_soft_sky = *t;
    alpi_lighting *soft = NULL, *direct = NULL;
    ALP_TRY(alpi_lighting_split_sky(t->lighting, &job->options.light.lighting, &soft, &direct));
    with_soft_sky.lighting = soft;
    // A sky that cannot be parted is asked as it is: that about a sun is bright.
    with_soft_sky.near_lighting = alpi_lighting_sky(direct) != NULL ? direct : t->lighting;
    const alp_result result = gather_light(job, &with_soft_sky, g, direct);
    t->values = with_soft_sky.values;
    alpi_lighting_destroy(job->context, soft);
    alpi_lighting_destroy(job->context, direct);
    return result;
}

alp_result alpi_bake_radiosity(alpi_bake_job *job, alpi_light_task *task)
{
    light_gatherers gatherers;
    alp_result result = make_gatherers(job, task->receivers->count, &gatherers);
    if (result == ALP_OK) {
        result = gather_with_sky(job, task, &gatherers);
    }
    alpi_scene_without_emitters_clear(&gatherers.dark);
    alpi_hemicube_destroy(gatherers.block_cube);
    alpi_hemicube_destroy(gatherers.texel_cube);
    return result;
}
