// SPDX-License-Identifier: MIT
// What a bake will take, told before it: texels by areas, rays and seconds by a few points that are
// lit as the texels will be.
#include "bake/layers.h"
#include "bake/light.h"
#include "bake/light_plan.h"

#include "atlas/factors.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "transport/direct.h"

#include <math.h>

enum { POINTS = 128, DIRECT_SAMPLES = 16, PATHS = 16, STREAM_PILOT = 90 };
// Measured on the truth table (docs/conventions.md, "Estimates").
static const double PAGE_SHARE = 0.9; // of a page that its charts leave for texels
static const double TEXELS_PER_CHART = 1500.0;
// Of texels that gather, others are interpolated: the lattice, and what lies along edges, whose
// share falls with the side of a map.
static const double LATTICE_SHARE = 1.0 / 16.0, EDGE_TEXELS = 50.0; // the latter × √texels
static const double BOUNCED_ERROR = 0.037; // of 64 rays, over the mean of all light
static const double BOUNCED_POWER = 1.6;   // of what is asked less, that rays grow with
static const double ALL_OVER_DIRECT = 1.5; // mean of all light over that of direct light
static const double PACKET_SHARE = 0.22;   // time of a ray in a packet, over that of a path
static const double TEXEL_SECONDS = 1e-6;  // atlas, files

/// What a few points tell of a scene.
typedef struct pilot {
    double variances[POINTS]; // of direct light by DIRECT_SAMPLES, mean of the channels
    double mean;              // of direct light
    double rays;              // of each direct sample
    double direct_seconds;    // of each of those
    double ray_seconds;       // of a ray that gathers bounced light or occlusion
} pilot;

// --- texels --------------------------------------------------------------------------------------

static bool is_chosen(const alpi_bake_job *job, uint32_t triangle)
{
    const alp_scene *s = job->scene;
    return s->triangle_usable[triangle] &&
           (job->only == NULL || job->only[s->triangle_surface[triangle]]);
}

static double area_of(const alp_scene *s, uint32_t triangle, vec3 *normal)
{
    vec3 p[3];
    for (int k = 0; k < 3; k++) {
        const float *v = s->positions[s->triangles[triangle][k]];
        p[k] = (vec3){v[0], v[1], v[2]};
    }
    const vec3 n = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
    const double length = sqrt((double)vec3_dot(n, n));
    *normal = length > 0.0 ? vec3_scale(n, (float)(1.0 / length)) : (vec3){0.0f, 0.0f, 1.0f};
    return 0.5 * length;
}

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

/// An atlas as it will about be. Whether it keeps a second set of coordinates is not looked at:
/// where there is one for all of the page, it is taken to.
static alp_atlas_info guess_atlas(const alpi_bake_job *job, double *area)
{
    const alp_atlas_options *o = &job->options.atlas;
    const alp_scene *s = job->scene;
    double uv_area = 0.0;
    *area = 0.0;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        if (is_chosen(job, t)) {
            vec3 normal;
            *area += area_of(s, t, &normal);
            uv_area += s->uvs[1] != NULL ? uv_area_of(s, t) : 0.0;
        }
    }
    const double page = (double)o->size * o->size;
    const bool keep = s->uvs[1] != NULL && alpi_atlas_may_keep(o);
    const bool fits = o->texels_per_metre == 0.0;
    const double texels = keep   ? fmin(uv_area, 1.0) * page
                          : fits ? PAGE_SHARE * page
                                 : *area * o->texels_per_metre * o->texels_per_metre;
    alp_atlas_info info = {.width = o->size, .height = o->size, .pages = 1};
    info.texels = (uint64_t)fmax(texels, 1.0);
    info.charts = (uint32_t)fmin(texels / TEXELS_PER_CHART + 1.0, s->usable_count);
    info.pages = (uint32_t)ceil(fmax(keep || fits ? 1.0 : texels / (PAGE_SHARE * page), 1.0));
    return info;
}

// --- the pilot -----------------------------------------------------------------------------------

/// Points on the chosen surfaces, evenly by area.
static void place_points(const alpi_bake_job *job, double area, alpi_point_array *points)
{
    const alp_scene *s = job->scene;
    const uint64_t seed = job->options.occlusion.seed;
    double end = 0.0;
    uint32_t placed = 0;
    for (uint32_t t = 0; t < s->triangle_count && placed < points->count; t++) {
        vec3 normal;
        end += is_chosen(job, t) ? area_of(s, t, &normal) : 0.0;
        for (; placed < points->count && end >= area * (placed + 0.5) / points->count; placed++) {
            const float u = alpi_unit_float(alpi_random_key(seed, placed, STREAM_PILOT));
            const float v = alpi_unit_float(alpi_random_key(seed, placed, STREAM_PILOT + 1));
            const float w[3] = {1.0f - sqrtf(u), sqrtf(u) * (1.0f - v), sqrtf(u) * v};
            vec3 corners[3], p = {0.0f, 0.0f, 0.0f};
            for (int k = 0; k < 3; k++) {
                const float *c = s->positions[s->triangles[t][k]];
                corners[k] = (vec3){c[0], c[1], c[2]};
                p = vec3_add(p, vec3_scale(corners[k], w[k]));
            }
            area_of(s, t, &normal);
            const float n[3] = {normal.x, normal.y, normal.z}, at[3] = {p.x, p.y, p.z};
            for (int k = 0; k < 3; k++) {
                points->positions[placed][k] = at[k];
                points->geometric_normals[placed][k] = points->shading_normals[placed][k] = n[k];
            }
            points->offsets[placed] = alpi_receiver_offset(p, corners);
        }
    }
    points->count = placed;
}

/// Direct light of the points.
static alp_result gather_direct(const alpi_bake_job *job, const alpi_receivers *receivers,
                                const alpi_tracer *tracer, const alpi_lighting *lighting,
                                alpi_direct_output *output)
{
    const alpi_direct_options options = {.context = job->context,
                                         .scene = job->scene,
                                         .tracer = tracer,
                                         .lighting = lighting,
                                         .filter = {.one_sided = job->options.occlusion.one_sided},
                                         .samples = DIRECT_SAMPLES,
                                         .seed = job->options.occlusion.seed};
    alpi_direct *direct = NULL;
    ALP_TRY(alpi_direct_create(&options, &direct));
    const alp_result result = alpi_direct_irradiance(direct, receivers, NULL, 0, NULL, output);
    alpi_direct_destroy(direct);
    return result;
}

/// What samples of direct light are for: all of it, but for the soft part of a sky.
static alp_result time_direct(const alpi_bake_job *job, const alpi_receivers *receivers,
                              const alpi_tracer *tracer, const alpi_lighting *lighting,
                              alpi_reference_value *values, pilot *p)
{
    alpi_direct_output output = {.values = values};
    alpi_lighting *soft = NULL, *spots = NULL;
    const bool parted = alpi_lighting_sky(lighting) != NULL && !alpi_tracer_has_panes(tracer);
    if (parted) {
        ALP_TRY(alpi_lighting_split_sky(lighting, &job->options.light.lighting, &soft, &spots));
    }
    const double began = alpi_seconds();
    const alp_result result =
        gather_direct(job, receivers, tracer, parted ? spots : lighting, &output);
    const double samples = (double)receivers->count * DIRECT_SAMPLES;
    p->direct_seconds = (alpi_seconds() - began) / samples;
    p->rays = (double)output.rays / samples;
    alpi_lighting_destroy(job->context, soft);
    alpi_lighting_destroy(job->context, spots);
    for (uint32_t i = 0; i < receivers->count; i++) {
        for (int k = 0; k < 3; k++) {
            p->variances[i] += (double)values[i].variance[k] / 3.0;
        }
    }
    return result;
}

static alp_result light_points(const alpi_bake_job *job, const alpi_receivers *receivers,
                               const alpi_tracer *tracer, const alpi_lighting *lighting,
                               alpi_reference_value *values, pilot *p)
{
    const alp_bake_options *o = &job->options;
    alpi_direct_output output = {.values = values};
    ALP_TRY(gather_direct(job, receivers, tracer, lighting, &output));
    for (uint32_t i = 0; i < receivers->count; i++) {
        for (int k = 0; k < 3; k++) {
            p->mean += (double)values[i].mean[k] / (3.0 * receivers->count);
        }
    }
    ALP_TRY(time_direct(job, receivers, tracer, lighting, values, p));
    const alpi_reference paths = {.context = job->context,
                                  .scene = job->scene,
                                  .tracer = tracer,
                                  .lighting = lighting,
                                  .filter = {.one_sided = o->occlusion.one_sided},
                                  .samples = PATHS,
                                  .bounces = 1,
                                  .seed = o->occlusion.seed};
    const double began = alpi_seconds();
    ALP_TRY(alpi_reference_irradiance(&paths, receivers, NULL, 0, NULL, values));
    const double rays = (double)receivers->count * PATHS;
    p->ray_seconds = PACKET_SHARE * (alpi_seconds() - began) / rays;
    return ALP_OK;
}

static alp_result run_pilot(const alpi_bake_job *job, double area, pilot *p, uint32_t *count)
{
    alpi_tracer *tracer = NULL;
    alpi_lighting *lighting = NULL;
    alpi_point_array points;
    *p = (pilot){.mean = 0.0};
    ALP_TRY(alpi_tracer_for_scene(job->scene, job->options.progress, job->options.progress_user,
                                  &tracer, NULL));
    ALP_TRY(alpi_lighting_create_quietly(job->scene, &job->options.light.lighting, &lighting));
    alp_result result = alpi_point_array_create(job->context, POINTS, &points);
    alpi_reference_value *values = ALPI_NEW(job->context, alpi_reference_value, POINTS);
    if (result == ALP_OK && values != NULL) {
        place_points(job, area, &points);
        const alpi_receivers receivers = alpi_point_array_receivers(&points);
        result = light_points(job, &receivers, tracer, lighting, values, p);
        *count = points.count;
    }
    result = values == NULL ? ALP_ERROR_OUT_OF_MEMORY : result;
    alpi_release(job->context, values);
    alpi_point_array_destroy(job->context, &points);
    alpi_lighting_destroy(job->context, lighting);
    return result;
}

// --- rays ----------------------------------------------------------------------------------------

/// Samples of a texel with a variance, known by DIRECT_SAMPLES.
static double deal_samples(double variance, double scale)
{
    enum { MOST = 65536 };
    const double power = 2.0 * ALPI_LIGHT_FIRST_POWER, had = DIRECT_SAMPLES;
    const double all = scale * pow(variance * pow(had, power), 1.0 / (power + 1.0));
    return fmin(fmax(all, had), MOST);
}

/// Samples of direct light for each texel, as light_more_direct.c would deal them out to texels
/// like these; what is added for the worst of a hundred is little, and left out.
static double count_direct(const alp_light_options *o, const pilot *p, uint32_t count)
{
    const double wanted = 0.75 * (double)o->error * ALL_OVER_DIRECT * p->mean;
    const double power = 2.0 * ALPI_LIGHT_FIRST_POWER;
    double low = -100.0, high = 100.0, mean = DIRECT_SAMPLES; // log2 of the scale
    for (int i = 0; i < 40 && wanted > 0.0; i++) {
        const double scale = exp2(0.5 * (low + high));
        double square = 0.0, samples = 0.0;
        for (uint32_t k = 0; k < count; k++) {
            const double dealt = deal_samples(p->variances[k], scale);
            square += p->variances[k] * pow(DIRECT_SAMPLES / dealt, power) / count;
            samples += dealt / count;
        }
        const bool good = square <= wanted * wanted;
        mean = good ? samples : mean;
        *(good ? &high : &low) = 0.5 * (low + high);
    }
    return mean;
}

static double find_traced_share(const alp_bake_options *o, double texels)
{
    return o->sampling.accuracy == ALP_ADAPTIVE_OFF
               ? 1.0
               : fmin(LATTICE_SHARE + EDGE_TEXELS / sqrt(fmax(texels, 1.0)), 1.0);
}

static void add_light(const alp_bake_options *o, const pilot *p, uint32_t count, alp_bake_work *w)
{
    const alp_light_options *l = &o->light;
    const double texels = (double)w->texels;
    double rays = l->samples;
    double direct = alpi_light_has_rounds(o) ? count_direct(l, p, count) : 4.0 * DIRECT_SAMPLES;
    if (l->bounces == 0) {
        direct = l->samples;
        rays = 0.0;
    } else if (l->gather == ALP_GATHER_HEMICUBE) {
        rays = 3.0 * l->hemicube * l->hemicube;
        rays *= l->emitters == ALP_EMITTERS_COUNTED ? 2.0 : 1.0;
    } else if (l->gather == ALP_GATHER_RAYS && l->error > 0.0f) {
        rays = 64.0 * fmax(pow(BOUNCED_ERROR / (double)l->error, BOUNCED_POWER), 1.0);
    }
    const double share = find_traced_share(o, (double)w->texels);
    rays = rays * share + (l->bounces > 0 ? alpi_light_block_rays(l, w->texels) / 8.0 : 0.0);
    w->rays += (uint64_t)(texels * (rays + direct * p->rays));
    w->seconds += texels * (rays * p->ray_seconds + direct * p->direct_seconds);
}

static void add_occlusion(const alp_bake_options *o, const pilot *p, alp_bake_work *w)
{
    const double wanted = (double)o->sampling.error;
    const double share = find_traced_share(o, (double)w->texels);
    double rays = o->occlusion.samples;
    if (wanted > 0.0) { // the error of these sequences falls as samples^−0.7
        rays = fmin(rays, 64.0 * fmax(pow(0.03 / wanted, 1.0 / 0.7), 1.0));
    }
    const double each = (double)w->texels * share * rays;
    w->rays += (uint64_t)each;
    w->seconds += each * p->ray_seconds;
    if ((o->maps & ALP_MAP_OBSCURANCE) != 0) {
        w->rays += (uint64_t)((double)w->texels * rays);
        w->seconds += (double)w->texels * rays * p->ray_seconds;
    }
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
    double area;
    uint32_t count = 0;
    pilot p;
    uint32_t lights;
    ALP_TRY(alpi_bake_check_output(job, 1)); // nobody waits for a guess at what is refused
    ALP_TRY(alpi_bake_choose(job));
    ALP_TRY(check_densities(job));
    ALP_TRY(alpi_bake_find_layers(job, &lights));
    const alp_atlas_info atlas = guess_atlas(job, &area);
    ALP_TRY(run_pilot(job, area, &p, &count));
    work->texels = atlas.texels;
    work->bytes = alpi_bake_memory(&atlas, job->scene, o) + alpi_bake_layers_memory(job, &atlas);
    work->seconds = (double)atlas.texels * TEXEL_SECONDS;
    if (alpi_bake_wants_occlusion(job)) {
        add_occlusion(o, &p, work);
    }
    if ((o->maps & ALP_MAP_LIGHT) != 0) {
        add_light(o, &p, count, work);
    }
    if (o->sampling.time_limit > 0.0 && work->seconds > o->sampling.time_limit) {
        work->rays = (uint64_t)((double)work->rays * o->sampling.time_limit / work->seconds);
        work->seconds = o->sampling.time_limit;
    }
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
    if (scene->usable_count == 0 || job.options.atlas.mode == ALP_ATLAS_VERTEX) {
        return ALP_OK;
    }
    const alp_result result = estimate(&job, work);
    alpi_bake_release_layers(&job);
    alpi_release(job.context, job.only);
    alpi_release(job.context, job.occluders);
    alpi_release(job.context, job.originals);
    return result;
}
