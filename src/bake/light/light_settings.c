// SPDX-License-Identifier: MIT
// Chooses how the light of a bake is computed.
//
// Errors of the solution that depend on the rays of patches, as measured:
// - A bias of the whole map, at most 1.5 / √rays of all patches together, of a bounce.
// - Noise about it, 1.6 / √rays of a patch, in percent of the light.
// Each is a quarter of the wanted error, or of the error that a texel's samples leave: about
// 16 / √samples percent. The root of both squares adds 3 % to that error.
#include "bake/light/light_settings.h"

#include "maps/radiosity/counted_emitters.h"

#include <math.h>

enum { PATCH_CUBE = 16 }; // pixels across the hemicube of a patch
enum { MOST_RAYS = 65536 };

/// The wanted error, or about the error that a texel's samples leave; 0: rounds use up the time.
static double find_error(const alp_light_options *o)
{
    return o->error > 0.0f          ? (double)o->error
           : o->samples < MOST_RAYS ? 0.16 / sqrt((double)o->samples)
                                    : 0.0;
}

// --- rounds --------------------------------------------------------------------------------------

bool alpi_light_is_in_rounds(const alp_bake_options *o)
{
    const bool may_end = o->sampling.time_limit > 0.0 || o->sampling.keep_partial;
    return (o->light.error > 0.0f || may_end) && o->light.gather == ALP_GATHER_RAYS;
}

static bool is_adaptive(const alp_bake_options *o)
{
    return o->light.gather == ALP_GATHER_RAYS && !o->light.denoise &&
           o->sampling.accuracy != ALP_ADAPTIVE_OFF;
}

/// A bake that may end early gets a whole round first. On small maps a pilot costs more than it
/// gains.
static bool is_piloted(const alp_bake_options *o, uint32_t lit)
{
    enum { LEAST_TEXELS = 32 * ALPI_LIGHT_PILOT_TEXELS };
    return alpi_light_is_in_rounds(o) && o->light.error > 0.0f && !o->sampling.keep_partial &&
           !(o->sampling.time_limit > 0.0) && lit >= LEAST_TEXELS;
}

static uint32_t find_most_rays(const alp_light_options *o)
{
    return o->error > 0.0f ? MOST_RAYS
                           : alpi_cosine_rays_samples(o->samples, ALPI_LIGHT_REPLICATES);
}

// --- direct light --------------------------------------------------------------------------------

/// Without rounds, the error of direct light is half of that of bounced light. Measured on the
/// Cornell box, this takes 64 samples beside 128 rays, and 128 beside 512. Fewer samples beside
/// fewer rays pay there, but not if light comes through windows.
static uint32_t find_direct_samples(const alp_bake_options *o)
{
    enum { IN_ROUNDS = 8, LEAST = 64, MOST = 512, RAYS = 128 };
    uint32_t samples = LEAST;
    if (alpi_light_is_in_rounds(o)) {
        return IN_ROUNDS;
    }
    while (samples < MOST && pow(samples * 2.0 / LEAST, 2.0) * RAYS <= o->light.samples) {
        samples *= 2;
    }
    return samples;
}

/// Direct light of a solution that no round refines: its noise is .4 % of the light by 16 samples,
/// as measured, and a third of the error here.
static uint32_t find_own_direct(const alp_light_options *o)
{
    enum { LEAST = 16, MOST = 1024 };
    static const double ERROR_OF_LEAST = 0.0125; // error for which the least is enough
    const double error = find_error(o);
    const double samples = error > 0.0 ? LEAST * pow(ERROR_OF_LEAST / error, 2.0) : LEAST;
    return (uint32_t)fmin(fmax(samples, LEAST), MOST);
}

// --- bounced light -------------------------------------------------------------------------------

static uint32_t find_patch_rays(const alp_light_options *o, uint64_t texels)
{
    enum { TEXELS_PER_PATCH = 5, FEWEST_RAYS = 16, MOST_PATCH_RAYS = 1024 };
    if (o->gather == ALP_GATHER_HEMICUBE) {
        return 3 * PATCH_CUBE * PATCH_CUBE; // a face, and four halves of one
    }
    const double error = find_error(o);
    if (error == 0.0) {
        return ALPI_RADIOSITY_PATCH_RAYS;
    }
    const double all = pow(6.0 / error, 2.0), about = pow(0.064 / error, 2.0);
    const double each = fmax(all * TEXELS_PER_PATCH / fmax((double)texels, 1.0), about);
    uint32_t rays = FEWEST_RAYS;
    while (rays * sqrt(2.0) < each && rays < MOST_PATCH_RAYS) { // the nearest power of two
        rays *= 2;
    }
    return rays;
}

/// Light that the passes leave out is a bias, mostly in a few places: .06 % of the light that a
/// sphere reflects onto a plane made .4 % of error. With a number of bounces and a number of
/// samples nothing is left out, so that no light changes the passes of another.
static double find_tolerance(const alp_light_options *o)
{
    static const double SHARE = 0.01, LEAST = 5e-5, MOST = 5e-4;
    return o->error > 0.0f || o->bounces > ALPI_RADIOSITY_PASS_LIMIT
               ? fmin(fmax(SHARE * find_error(o), LEAST), MOST)
               : 0.0;
}

/// A ray through a million triangles takes about three times as long as one through 16,384
/// (`alpenglow bench light`), and a ray that meets masks about twice as long as others.
static double find_ray_limit(const alpi_bake_job *job, uint32_t lit)
{
    static const double RAYS_OF_TEXEL = 1024.0, LEAST_TEXELS = 0x1p17, FEW_TRIANGLES = 0x1p14;
    const alp_scene *scene = job->scene;
    const alp_light_options *o = &job->options.light;
    const double triangles = fmax((double)scene->triangle_count, FEW_TRIANGLES);
    bool masks = false;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        masks = masks || (alpi_surface_has_cuts(scene, s) && !alpi_surface_is_pane(scene, s));
    }
    return o->bounded && o->error > 0.0f ? RAYS_OF_TEXEL * fmax(lit, LEAST_TEXELS) *
                                               cbrt(FEW_TRIANGLES / triangles) * (masks ? 0.5 : 1.0)
                                         : HUGE_VAL;
}

alpi_light_settings alpi_light_choose(const alpi_bake_job *job, uint64_t texels, uint32_t lit)
{
    const alp_bake_options *o = &job->options;
    const double limit = find_ray_limit(job, lit);
    return (alpi_light_settings){
        .in_rounds = alpi_light_is_in_rounds(o),
        .adaptive = is_adaptive(o),
        .piloted = is_piloted(o, lit),
        .patch_rays = find_patch_rays(&o->light, texels),
        .direct_samples = find_direct_samples(o),
        .own_direct = find_own_direct(&o->light),
        .most_rays = find_most_rays(&o->light),
        .tolerance = find_tolerance(&o->light),
        .ray_limit = limit,
        // The passes of all layers share as many rays as later rounds.
        .pass_ray_limit = isinf(limit) ? 0.0 : limit / (1.0 + job->layers.light.count),
    };
}

// --- gatherers -----------------------------------------------------------------------------------

static alp_result make_hemicubes(const alpi_bake_job *job, alpi_light_gatherers *g)
{
    const uint32_t n = job->options.light.hemicube;
    ALP_TRY(alpi_hemicube_create(job->context, n, &g->texel_cube));
    ALP_TRY(alpi_hemicube_create(job->context, n < PATCH_CUBE ? n : PATCH_CUBE, &g->patch_cube));
    g->texel_cubes = (alpi_hemicube_options){.context = job->context,
                                             .cube = g->texel_cube,
                                             .turned = true,
                                             .seed = job->options.occlusion.seed};
    g->patch_cubes = g->texel_cubes;
    g->patch_cubes.cube = g->patch_cube;
    g->patch_cubes.scattered = true;
    g->patches = alpi_hemicube_gatherer(&g->patch_cubes);
    g->texels = alpi_hemicube_gatherer(&g->texel_cubes);
    g->counted = job->options.light.emitters == ALP_EMITTERS_COUNTED;
    return g->counted ? alpi_scene_without_emitters(job->scene, &g->dark) : ALP_OK;
}

alp_result alpi_light_gatherers_create(const alpi_bake_job *job,
                                       const alpi_light_settings *settings, alpi_light_gatherers *g)
{
    *g = (alpi_light_gatherers){0};
    if (job->options.light.gather == ALP_GATHER_HEMICUBE) {
        return make_hemicubes(job, g);
    }
    g->patch_rays = (alpi_cosine_rays){.context = job->context,
                                       .samples = settings->patch_rays,
                                       .replicates = 1,
                                       .seed = job->options.occlusion.seed};
    g->patches = alpi_cosine_rays_gatherer(&g->patch_rays);
    return ALP_OK;
}

void alpi_light_gatherers_clear(alpi_light_gatherers *g)
{
    alpi_scene_without_emitters_clear(&g->dark);
    alpi_hemicube_destroy(g->patch_cube);
    alpi_hemicube_destroy(g->texel_cube);
}

// --- the sky split -------------------------------------------------------------------------------

alp_result alpi_light_split_sky(const alpi_bake_job *job, const alpi_lighting *lighting,
                                const alpi_tracer *tracer, alpi_light_sources *s)
{
    *s = (alpi_light_sources){.gathered = lighting, .sampled = lighting, .near = lighting};
    const bool split =
        job->only == NULL && alpi_lighting_sky(lighting) != NULL && !alpi_tracer_has_panes(tracer);
    if (!split) {
        return ALP_OK;
    }
    ALP_TRY(alpi_lighting_split_sky(lighting, &job->options.light.lighting, &s->soft, &s->spots));
    s->gathered = s->soft;
    s->sampled = s->spots;
    // A sky without bright spots has no part that near rays could sample.
    s->near = alpi_lighting_sky(s->spots) != NULL ? s->spots : lighting;
    return ALP_OK;
}

void alpi_light_sources_clear(alp_context *context, alpi_light_sources *s)
{
    alpi_lighting_destroy(context, s->soft);
    alpi_lighting_destroy(context, s->spots);
}
