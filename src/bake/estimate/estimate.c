// SPDX-License-Identifier: MIT
// The work of a bake, from areas and options alone: no ray is traced.
#include "bake/bake_memory.h"
#include "bake/bake_stages.h"
#include "bake/check.h"
#include "bake/files/outputs.h"
#include "bake/layer_plan.h"
#include "bake/light/light_settings.h"
#include "bake/settings.h"

#include "atlas/factors.h"
#include "base/memory.h"
#include "transport/direct/direct.h"

#include <math.h>

// Rays of a texel in the first round for an error, about. Later rounds depend on the scene.
enum { FIRST_RAYS = 64, TEXELS_PER_PATCH = 5 };
static const double PAGE_SHARE = 0.84; // of a page that its charts leave for texels
static const double TEXELS_PER_CHART = 1500.0;
// Of n texels the lattice traces LATTICE_SHARE × n; along edges further texels are traced, × √n.
static const double LATTICE_SHARE = 1.0 / 16.0, EDGE_TEXELS = 50.0, LIT_EDGE_TEXELS = 25.0;
// Samples of a light that trace a ray: the others aim below the horizon of their texel.
static const double SHADOW_SHARE = 0.5;

// --- texels --------------------------------------------------------------------------------------

/// Whether the maps of a bake have texels of their own for a triangle.
static bool is_chosen(const alpi_bake_job *job, uint32_t triangle)
{
    const alp_scene *s = job->scene;
    const uint32_t surface = s->triangle_surface[triangle];
    return s->triangle_usable[triangle] && (job->only == NULL || job->only[surface]) &&
           (job->originals == NULL || job->originals[surface] == surface);
}

static double area_of(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_triangle_area(c[0], c[1], c[2]);
}

/// Share of the unit square that a triangle takes in the second UV set.
static double uv_area_of(const alp_scene *s, uint32_t triangle)
{
    const uint32_t *v = s->triangles[triangle];
    const float(*uv)[2] = (const float(*)[2])s->uvs[1];
    const double a[2] = {(double)uv[v[1]][0] - (double)uv[v[0]][0],
                         (double)uv[v[1]][1] - (double)uv[v[0]][1]};
    const double b[2] = {(double)uv[v[2]][0] - (double)uv[v[0]][0],
                         (double)uv[v[2]][1] - (double)uv[v[0]][1]};
    return 0.5 * fabs(a[0] * b[1] - a[1] * b[0]);
}

/// A number as a count: at most 2^62, which no bake comes near; 0 for NaN.
static uint64_t to_count(double number)
{
    return (uint64_t)fmin(fmax(number, 0.0), 0x1p62);
}

/// Guesses the atlas. A second UV set is taken as kept where the options allow that; whether it is
/// valid is not examined.
static alp_atlas_info guess_atlas(const alpi_bake_job *job)
{
    const alp_atlas_options *o = &job->options.atlas;
    const alp_scene *s = job->scene;
    double area = 0.0, uv_area = 0.0;
    uint32_t triangles = 0;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        if (is_chosen(job, t)) {
            area += area_of(s, t);
            uv_area += s->uvs[1] != NULL ? uv_area_of(s, t) : 0.0;
            triangles++;
        }
    }
    const double page = (double)o->size * o->size, density = o->texels_per_metre;
    const bool keep = s->uvs[1] != NULL && alpi_atlas_may_keep(o), fits = density == 0.0;
    const double texels = keep   ? fmin(uv_area, 1.0) * page
                          : fits ? PAGE_SHARE * page
                                 : area * density * density;
    const double pages = keep || fits ? 1.0 : ceil(texels / (PAGE_SHARE * fmax(page, 1.0)));
    return (alp_atlas_info){.width = o->size,
                            .height = o->size,
                            .pages = (uint32_t)fmin(fmax(pages, 1.0), 65536.0),
                            .charts = (uint32_t)fmin(texels / TEXELS_PER_CHART + 1.0, triangles),
                            .texels = to_count(fmax(texels, 1.0))};
}

// --- rays ----------------------------------------------------------------------------------------

/// Texels that trace rays; the others are interpolated.
static double count_traced(const alp_bake_options *o, double texels, double edge_texels)
{
    const double traced = LATTICE_SHARE * texels + edge_texels * sqrt(texels);
    return o->sampling.accuracy == ALP_ADAPTIVE_OFF ? texels : fmin(traced, texels);
}

static double count_occlusion_rays(const alp_bake_options *o, double texels)
{
    const double samples =
        o->sampling.error > 0.0f ? fmin(o->occlusion.samples, FIRST_RAYS) : o->occlusion.samples;
    const bool colours = (o->maps & ALP_MAP_OBSCURANCE) != 0; // all texels trace rays for them
    return samples * (count_traced(o, texels, EDGE_TEXELS) + (colours ? texels : 0.0));
}

/// Kinds of light of which each takes a ray of a sample: the parts of direct light.
static alp_result count_lights(const alpi_bake_job *job, uint32_t *lights)
{
    alpi_lighting *lighting = NULL;
    alpi_direct *direct = NULL;
    ALP_TRY(alpi_lighting_create_quietly(job->scene, &job->options.light.lighting, &lighting));
    const alpi_direct_options options = {
        .context = job->context, .scene = job->scene, .lighting = lighting, .samples = 1};
    const alp_result result = alpi_direct_create(&options, &direct);
    if (result == ALP_OK) {
        alpi_direct_parts(direct, lights);
    }
    alpi_direct_destroy(direct);
    alpi_lighting_destroy(job->context, lighting);
    return result;
}

/// Rays by which a texel gathers bounced light.
static double count_gathered(const alp_light_options *l)
{
    const double faces = l->emitters == ALP_EMITTERS_COUNTED ? 2.0 : 1.0;
    return l->gather == ALP_GATHER_HEMICUBE ? faces * 3.0 * l->hemicube * l->hemicube
           : l->error > 0.0f                ? FIRST_RAYS
                                            : l->samples;
}

static double count_light_rays(const alpi_bake_job *job, double texels, uint32_t lights)
{
    const alp_bake_options *o = &job->options;
    const alp_light_options *l = &o->light;
    if (l->bounces == 0) {
        return SHADOW_SHARE * texels * l->samples * lights;
    }
    if (l->gather == ALP_GATHER_PATHS) {
        return texels * l->samples;
    }
    const double patches = texels / TEXELS_PER_PATCH;
    const alpi_light_settings settings =
        alpi_light_choose(job, to_count(texels), (uint32_t)to_count(texels));
    const double times = l->layers ? 2.0 : 1.0; // layers trace the rays of texels once more
    return SHADOW_SHARE * texels * settings.direct_samples * lights +
           patches * settings.patch_rays +
           times * count_gathered(l) * count_traced(o, texels, LIT_EDGE_TEXELS);
}

static alp_result check_densities(const alpi_bake_job *job)
{
    float *factors = NULL;
    const alp_result result =
        alpi_factors_create(job->scene, job->options.atlas.densities, &factors);
    alpi_release(job->context, factors);
    return result;
}

static alp_result estimate(alpi_bake_job *job, alp_bake_work *work)
{
    const alp_bake_options *o = &job->options;
    const bool occlusion = alpi_bake_wants_occlusion(o), light = (o->maps & ALP_MAP_LIGHT) != 0;
    uint32_t lights = 0;
    ALP_TRY(alpi_bake_check(job));
    if (o->atlas.mode == ALP_ATLAS_VERTEX) {
        return ALP_OK;
    }
    ALP_TRY(alpi_bake_check_output(job, 1));
    ALP_TRY(alpi_bake_choose_surfaces(job));
    ALP_TRY(check_densities(job));
    ALP_TRY(alpi_bake_find_layers(job, &lights));
    ALP_TRY(light ? count_lights(job, &lights) : ALP_OK);
    const alp_atlas_info atlas = guess_atlas(job);
    const double texels = (double)atlas.texels;
    work->texels = atlas.texels;
    work->bytes = alpi_bake_forecast_memory(job, &atlas).bytes;
    work->rays = to_count((occlusion ? count_occlusion_rays(o, texels) : 0.0) +
                          (light ? count_light_rays(job, texels, lights) : 0.0));
    work->rays_at_least =
        (occlusion && o->sampling.error > 0.0f) || (light && o->light.error > 0.0f);
    return ALP_OK;
}

alp_result alp_bake_estimate(const alp_scene *scene, const alp_bake_options *options,
                             alp_bake_work *work)
{
    *work = (alp_bake_work){0};
    if (scene == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    alpi_bake_job job = {.scene = scene,
                         .context = scene->context,
                         .options = options ? *options : alp_bake_options_default()};
    if (scene->usable_count == 0) {
        return ALP_OK;
    }
    const alp_result result = estimate(&job, work);
    alpi_bake_release_layers(&job);
    alpi_release(job.context, job.only);
    alpi_release(job.context, job.occluders);
    alpi_release(job.context, job.originals);
    return result;
}
