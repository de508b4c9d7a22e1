// SPDX-License-Identifier: MIT
// What a bake will take, told before it: texels by areas, rays and seconds by a few points that are
// lit as the texels will be.
#include "bake/bake_memory.h"
#include "bake/check.h"
#include "bake/estimate/pilot.h"
#include "bake/files/outputs.h"
#include "bake/layers.h"
#include "bake/light/light.h"
#include "bake/light/light_plan.h"
#include "bake/bake_stages.h"

#include "atlas/factors.h"
#include "base/memory.h"

#include <math.h>

enum { MOST_RAYS = 65536, MOST_FIRST_RAYS = 1024 }; // of a texel; and for an error in one round
// Measured on the truth table (docs/conventions.md, "Limits and estimates").
static const double PAGE_SHARE = 0.84; // of a page that its charts leave for texels
static const double TEXELS_PER_CHART = 1500.0;
// Of texels that gather, others are interpolated: the lattice, and what lies along edges, whose
// share falls with the side of a map.
static const double LATTICE_SHARE = 1.0 / 16.0;
static const double EDGE_TEXELS = 50.0, LIT_EDGE_TEXELS = 25.0; // × √texels: of occlusion, of light
static const double WIDE_EDGE_TEXELS = 20.0;                    // of light whose lattice is wide
static const double BOUNCED_OVER_PATHS = 0.46; // error of 64 rays of a texel, over that of paths
static const double BOUNCED_POWER = 1.38;      // of what is asked less, that rays grow with
static const double DIRECT_SHARE = 0.65;   // of texels that gather direct light, by direct_map.c
static const double ALL_OVER_DIRECT = 1.5; // mean of all light over that of direct light
static const double OCCLUSION_POWER = 1.0 / 0.7; // the same of occlusion
static const double ERROR_OVER_POINTS = 1.3;     // of occlusion, of texels over that of points
// Where there is a triangle for each texel charts leave more gaps, and errors and what is traced
// grow, by this.
static const double LOST_TO_GAPS = 0.3, ERROR_OF_DETAIL = 1.5, TRACED_OF_DETAIL = 1.0;
static const double NEAR_OF_DETAIL = 1.5;    // of a ray's time: more texels have surfaces near
static const double PROBE_SHARE = 1.0 / 8.0; // of traced texels' rays, to state the error
// Seconds of what is not rays: with charts, by triangles and texels; by pixels of a map.
static const double ATLAS_SECONDS = 0.05, TRIANGLE_SECONDS = 14e-6, TEXEL_SECONDS = 0.6e-6;
static const double KEPT_TRIANGLE_SECONDS = 1e-6, SEAM_SECONDS = 8e-6; // by triangles
static const double PIXEL_SECONDS = 0.6e-6;
static const double LIT_SECONDS = 2e-6, SHADED_SECONDS = 0.5e-6; // of a texel, besides its rays

// --- texels --------------------------------------------------------------------------------------

/// Share of the unit square of the second coordinates that a triangle takes.
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

/// What is known of a bake before it.
typedef struct work_guess {
    const alp_bake_options *options;
    alpi_pilot pilot;
    double area;   // of the surfaces, m²
    double texels; // at least 1
    double detail; // triangles in the area of a texel, at most 1
    uint32_t triangles;
} work_guess;

/// Of any number: 2^62 at most, which no bake comes near; 0 of what is none.
static uint64_t to_count(double number)
{
    return (uint64_t)fmin(fmax(number, 0.0), 0x1p62);
}

static bool keeps(const alp_bake_options *o, const alp_scene *s)
{
    return s->uvs[1] != NULL && alpi_atlas_may_keep(&o->atlas);
}

/// An atlas as it will about be. Whether it keeps a second set of coordinates is not looked at:
/// where there is one for all of the page, it is taken to.
static alp_atlas_info guess_atlas(const alpi_bake_job *job, work_guess *g)
{
    const alp_atlas_options *o = &job->options.atlas;
    const alp_scene *s = job->scene;
    double uv_area = 0.0;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        if (alpi_pilot_is_chosen(job, t)) {
            g->area += alpi_pilot_area(s, t);
            uv_area += s->uvs[1] != NULL ? uv_area_of(s, t) : 0.0;
            g->triangles++;
        }
    }
    const double page = (double)o->size * o->size;
    const bool keep = keeps(&job->options, s), fits = o->texels_per_metre == 0.0;
    const double texels = keep   ? fmin(uv_area, 1.0) * page
                          : fits ? PAGE_SHARE * page
                                 : g->area * o->texels_per_metre * o->texels_per_metre;
    g->detail = fmin(g->triangles / fmax(texels, 1.0), 1.0);
    g->texels = fmax(texels * (keep || !fits ? 1.0 : 1.0 - LOST_TO_GAPS * g->detail), 1.0);
    alp_atlas_info info = {.width = o->size, .height = o->size, .pages = 1};
    const double pages = keep || fits ? 1.0 : ceil(texels / (PAGE_SHARE * fmax(page, 1.0)));
    info.texels = to_count(g->texels);
    info.charts = (uint32_t)fmin(texels / TEXELS_PER_CHART + 1.0, g->triangles);
    info.pages = (uint32_t)fmin(fmax(pages, 1.0), 65536.0);
    return info;
}

// --- rays ----------------------------------------------------------------------------------------

/// Samples of a texel with a variance, known by ALPI_PILOT_DIRECT_SAMPLES.
static double deal_samples(double variance, double scale)
{
    const double power = 2.0 * ALPI_LIGHT_FIRST_POWER, had = ALPI_PILOT_DIRECT_SAMPLES;
    const double all = scale * pow(variance * pow(had, power), 1.0 / (power + 1.0));
    return fmin(fmax(all, had), MOST_RAYS);
}

/// Samples of direct light for each texel, as light_more_direct.c would deal them out to texels
/// like these, less the first of those that are interpolated; what is added for the worst of a
/// hundred is little, and left out.
static double count_direct(const work_guess *g)
{
    const alpi_pilot *p = &g->pilot;
    const double wanted = 0.75 * (double)g->options->light.error * ALL_OVER_DIRECT * p->mean;
    const double power = 2.0 * ALPI_LIGHT_FIRST_POWER;
    double low = -100.0, high = 100.0, mean = ALPI_PILOT_DIRECT_SAMPLES; // log2 of the scale
    for (int i = 0; i < 40 && wanted > 0.0; i++) {
        const double scale = exp2(0.5 * (low + high));
        double square = 0.0, samples = 0.0;
        for (uint32_t k = 0; k < p->count; k++) {
            const double dealt = deal_samples(p->variances[k], scale);
            square += p->variances[k] * pow(ALPI_PILOT_DIRECT_SAMPLES / dealt, power) / p->count;
            samples += dealt / p->count;
        }
        const bool good = square <= wanted * wanted;
        mean = good ? samples : mean;
        *(good ? &high : &low) = 0.5 * (low + high);
    }
    const bool between = alpi_light_direct_error(g->options) > 0.0;
    return mean - (between ? 1.0 - DIRECT_SHARE : 0.0) * ALPI_PILOT_DIRECT_SAMPLES;
}

/// Of errors, by texels that many triangles share.
static double find_growth(const work_guess *g)
{
    return 1.0 + ERROR_OF_DETAIL * g->detail;
}

static double find_traced_share(const work_guess *g, bool wide, double edge_texels)
{
    const double share = LATTICE_SHARE / (wide ? 4.0 : 1.0) + edge_texels / sqrt(g->texels);
    return g->options->sampling.accuracy == ALP_ADAPTIVE_OFF
               ? 1.0
               : fmin(share * (1.0 + TRACED_OF_DETAIL * g->detail), 1.0);
}

/// Rays of a traced texel for bounced light.
static double count_bounced(const work_guess *g)
{
    const alp_light_options *l = &g->options->light;
    const alpi_pilot *p = &g->pilot;
    const double light = fmax(ALL_OVER_DIRECT * p->mean, p->once_bounced);
    const double wanted = (double)l->error * light;
    if (l->bounces == 0) {
        return 0.0;
    }
    if (l->gather == ALP_GATHER_HEMICUBE) {
        const double faces = l->emitters == ALP_EMITTERS_COUNTED ? 2.0 : 1.0;
        return faces * 3.0 * l->hemicube * l->hemicube;
    }
    if (!(l->error > 0.0f)) {
        return l->samples;
    }
    const double error = BOUNCED_OVER_PATHS * find_growth(g) * p->bounced_error;
    const double over = wanted > 0.0 ? error / wanted : 0.0;
    return fmin(ALPI_PILOT_RAYS * fmax(pow(over, BOUNCED_POWER), 1.0), MOST_RAYS);
}

/// Rays of blocks, for each texel: what bounces at all is about half as much again as what bounces
/// once, and uneven by as much.
static double count_block_rays(const work_guess *g)
{
    enum { TEXELS_OF_BLOCK = 8 };
    const alpi_pilot *p = &g->pilot;
    const double once = p->once_bounced > p->mean ? 1.0 - p->mean / p->once_bounced : 0.0;
    const alpi_trial_light light = {.blocks = (uint32_t)fmin(g->texels / TEXELS_OF_BLOCK, 1e9),
                                    .mean = fmin(1.5 * once, 1.0),
                                    .rms = fmin(2.25 * once, 1.0)};
    return (double)alpi_light_sent_block_rays(&g->options->light, to_count(g->texels), &light) /
           TEXELS_OF_BLOCK;
}

/// @param layers that there are besides the whole
static void add_light(const work_guess *g, uint32_t layers, alp_bake_work *w)
{
    const alp_light_options *l = &g->options->light;
    if (l->gather == ALP_GATHER_PATHS && l->bounces > 0) { // from every texel, which asks all light
        const double paths = g->texels * l->samples;
        w->rays += to_count(paths);
        w->seconds += paths * g->pilot.path_seconds;
        return;
    }
    const double direct = l->bounces == 0                     ? l->samples
                          : alpi_light_has_rounds(g->options) ? count_direct(g)
                                                              : 4.0 * ALPI_PILOT_DIRECT_SAMPLES;
    const bool wide = alpi_light_has_wide_lattice(l);
    const double share = find_traced_share(g, wide, wide ? WIDE_EDGE_TEXELS : LIT_EDGE_TEXELS);
    double rays = count_bounced(g) * share;
    if (layers > 0) { // those of a round are sent once more, and kept
        const double kept = l->error > 0.0f ? fmin(rays, MOST_FIRST_RAYS * share) : rays;
        w->bytes += to_count(g->texels * kept * sizeof(uint32_t));
        rays *= 2.0;
    }
    rays += l->bounces > 0 ? count_block_rays(g) : 0.0;
    w->rays += to_count(g->texels * (rays + direct * g->pilot.rays));
    const double ray_seconds = (1.0 + NEAR_OF_DETAIL * g->detail) * g->pilot.ray_seconds;
    w->seconds += g->texels * (LIT_SECONDS + rays * ray_seconds + direct * g->pilot.direct_seconds);
}

static void add_occlusion(const work_guess *g, alp_bake_work *w)
{
    const alp_bake_options *o = g->options;
    const double wanted = (double)o->sampling.error;
    const double share = (1.0 + PROBE_SHARE) * find_traced_share(g, false, EDGE_TEXELS);
    double rays = o->occlusion.samples;
    if (wanted > 0.0) {
        const double over = ERROR_OVER_POINTS * find_growth(g) * g->pilot.occlusion_error / wanted;
        rays = fmin(rays, ALPI_PILOT_RAYS * fmax(pow(over, OCCLUSION_POWER), 1.0));
    }
    const bool colours = (o->maps & ALP_MAP_OBSCURANCE) != 0; // with rays of its own, of all texels
    const double each = g->texels * rays * (share + (colours ? 1.0 : 0.0));
    w->rays += to_count(each);
    w->seconds += g->texels * SHADED_SECONDS + each * g->pilot.occlusion_seconds;
}

/// Seconds before and after the rays.
static double find_other_seconds(const work_guess *g, const alp_scene *s,
                                 const alp_atlas_info *atlas)
{
    const bool keep = keeps(g->options, s);
    const double pixels = (double)atlas->pages * atlas->width * atlas->height;
    const double each = keep ? KEPT_TRIANGLE_SECONDS : TRIANGLE_SECONDS;
    return (keep ? 0.0 : ATLAS_SECONDS) + (each + SEAM_SECONDS) * g->triangles +
           TEXEL_SECONDS * g->texels + PIXEL_SECONDS * pixels;
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
    work_guess g = {.options = o};
    uint32_t lights;
    ALP_TRY(alpi_bake_check(job));
    if (o->atlas.mode == ALP_ATLAS_VERTEX) {
        return ALP_OK;
    }
    ALP_TRY(alpi_bake_check_output(job, 1));
    ALP_TRY(alpi_bake_choose_surfaces(job));
    ALP_TRY(check_densities(job));
    ALP_TRY(alpi_bake_find_layers(job, &lights));
    const alp_atlas_info atlas = guess_atlas(job, &g);
    ALP_TRY(alpi_pilot_run(job, g.area, sqrt(g.area / g.texels), &g.pilot));
    work->texels = atlas.texels;
    work->bytes = alpi_bake_memory(&atlas, job->scene, o) + alpi_bake_layers_memory(job, &atlas);
    if (alpi_bake_wants_occlusion(o)) {
        add_occlusion(&g, work);
    }
    if ((o->maps & ALP_MAP_LIGHT) != 0) {
        add_light(&g, job->layers.light.count, work);
    }
    const double limit = o->sampling.time_limit;
    if (limit > 0.0 && work->seconds > limit) {
        work->rays = to_count((double)work->rays * limit / work->seconds);
        work->seconds = limit;
    }
    work->seconds += find_other_seconds(&g, job->scene, &atlas);
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
