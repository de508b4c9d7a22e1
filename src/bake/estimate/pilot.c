// SPDX-License-Identifier: MIT
#include "bake/estimate/pilot.h"

#include "bake/objects.h"
#include "bake/settings.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "maps/radiosity/counted_emitters.h"
#include "maps/texels/stated_error.h"
#include "transport/direct/direct.h"
#include "transport/occlusion/occlusion.h"
#include "transport/paths/reference.h"

#include <math.h>
#include <time.h>

enum {
    STREAM_PLACE = 90,
    BLOCK = ALPI_PACKET, // points of occlusion side by side, as texels that follow each other are
    BLOCKS = 256
};
// Time of a ray in a packet of a gatherer, over that of a path's. Measured on the truth table.
static const double PACKET_SHARE = 0.22;
// Spread of the quarters of a sequence, over its error: they are not independent.
static const double SPREAD_OVER_ERROR = 1.8;

bool alpi_pilot_is_chosen(const alpi_bake_job *job, uint32_t triangle)
{
    const alp_scene *s = job->scene;
    const uint32_t surface = s->triangle_surface[triangle];
    return s->triangle_usable[triangle] && (job->only == NULL || job->only[surface]) &&
           (job->originals == NULL || job->originals[surface] == surface);
}

double alpi_pilot_area(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_triangle_area(c[0], c[1], c[2]);
}

// --- time ----------------------------------------------------------------------------------------

typedef struct stopwatch {
    double wall;
    clock_t processor; // of all threads
} stopwatch;

static stopwatch start_watch(void)
{
    return (stopwatch){alpi_seconds(), clock()};
}

/// Seconds since, had all workers had as much to do: points are too few to keep them busy.
static double read_watch(const alpi_bake_job *job, const stopwatch *from)
{
    const double processor = (double)(clock() - from->processor) / CLOCKS_PER_SEC;
    return fmin(alpi_seconds() - from->wall, processor / alp_context_worker_count(job->context));
}

// --- points --------------------------------------------------------------------------------------

static void put_point(alpi_point_array *points, uint32_t i, vec3 at, vec3 normal,
                      const vec3 corners[3])
{
    vec3_store(points->positions[i], at);
    vec3_store(points->geometric_normals[i], normal);
    vec3_store(points->shading_normals[i], normal);
    points->offsets[i] = alpi_receiver_offset(at, corners);
}

/// A random point of a triangle and, in its plane, the rest of a block of 4 × 2 with it in the
/// corner.
static void place_block(const alp_scene *s, uint32_t triangle, uint64_t seed, double spacing,
                        uint32_t block, uint32_t first, alpi_point_array *points)
{
    vec3 corners[3], along, across;
    const float u = alpi_unit_float(alpi_random_key(seed, first, STREAM_PLACE));
    const float v = alpi_unit_float(alpi_random_key(seed, first, STREAM_PLACE + 1));
    const float w[3] = {1.0f - sqrtf(u), sqrtf(u) * (1.0f - v), sqrtf(u) * v};
    alpi_triangle_corners(s, triangle, corners);
    const vec3 up = {0.0f, 1.0f, 0.0f};
    const vec3 normal = vec3_triangle_normal(corners[0], corners[1], corners[2], up);
    vec3_frame(normal, &along, &across);
    const vec3 at =
        vec3_mad(vec3_mad(vec3_scale(corners[0], w[0]), w[1], corners[1]), w[2], corners[2]);
    for (uint32_t i = 0; i < block; i++) {
        const uint32_t column = i % 4, row = i / 4;
        const float x = (float)(spacing * column), y = (float)(spacing * row);
        put_point(points, first + i, vec3_mad(vec3_mad(at, x, along), y, across), normal, corners);
    }
}

/// Fills the array with blocks, evenly by area.
static void place_points(const alpi_bake_job *job, double area, double spacing, uint32_t block,
                         alpi_point_array *points)
{
    const alp_scene *s = job->scene;
    const uint32_t blocks = points->count / block;
    double end = 0.0;
    uint32_t placed = 0;
    for (uint32_t t = 0; t < s->triangle_count && placed < blocks; t++) {
        if (!alpi_pilot_is_chosen(job, t)) {
            continue;
        }
        end += alpi_pilot_area(s, t);
        for (; placed < blocks && end >= area * (placed + 0.5) / blocks; placed++) {
            place_block(s, t, job->options.occlusion.seed, spacing, block, placed * block, points);
        }
    }
    points->count = placed * block;
}

// --- light ---------------------------------------------------------------------------------------

/// What light of a pilot is gathered with.
typedef struct light_pilot {
    const alpi_bake_job *job;
    const alpi_receivers *receivers;
    const alpi_tracer *tracer;
    const alpi_lighting *lighting;
    alpi_lighting *soft, *spots; // parts of a sky, NULL where it is not parted
    alpi_reference_value *values;
    alpi_pilot *pilot;
} light_pilot;

static double mean_of(const float channels[3])
{
    return ((double)channels[0] + (double)channels[1] + (double)channels[2]) / 3.0;
}

static alp_result gather_direct(const light_pilot *l, const alpi_lighting *lighting, uint64_t *rays)
{
    const alpi_bake_job *job = l->job;
    alpi_direct_output output = {.values = l->values};
    const alpi_direct_options options = {.context = job->context,
                                         .scene = job->scene,
                                         .tracer = l->tracer,
                                         .lighting = lighting,
                                         .filter = {.one_sided = job->options.occlusion.one_sided},
                                         .samples = ALPI_PILOT_DIRECT_SAMPLES,
                                         .seed = job->options.occlusion.seed};
    alpi_direct *direct = NULL;
    ALP_TRY(alpi_direct_create(&options, &direct));
    const alp_result result = alpi_direct_irradiance(direct, l->receivers, NULL, 0, NULL, &output);
    alpi_direct_destroy(direct);
    *rays = output.rays;
    return result;
}

/// All of direct light, for its mean; then, where a sky is parted, what samples of it are for: all
/// but the soft part. Once before, as what is asked first waits for memory.
static alp_result light_directly(const light_pilot *l)
{
    alpi_pilot *p = l->pilot;
    uint64_t rays;
    ALP_TRY(gather_direct(l, l->lighting, &rays));
    for (uint32_t i = 0; i < p->count; i++) {
        p->mean += mean_of(l->values[i].mean) / p->count;
    }
    const stopwatch began = start_watch();
    ALP_TRY(gather_direct(l, l->spots != NULL ? l->spots : l->lighting, &rays));
    const double samples = (double)p->count * ALPI_PILOT_DIRECT_SAMPLES;
    p->direct_seconds = read_watch(l->job, &began) / samples;
    p->rays = (double)rays / samples;
    for (uint32_t i = 0; i < p->count; i++) {
        p->variances[i] = mean_of(l->values[i].variance);
    }
    return ALP_OK;
}

/// @param next_event false: light is found by cosine rays alone
static alp_result send_paths(const light_pilot *l, const alp_scene *scene,
                             const alpi_lighting *lighting, uint32_t bounces, bool next_event)
{
    const alpi_reference paths = {.context = l->job->context,
                                  .scene = scene,
                                  .tracer = l->tracer,
                                  .lighting = lighting,
                                  .filter = {.one_sided = l->job->options.occlusion.one_sided},
                                  .samples = ALPI_PILOT_RAYS,
                                  .bounces = bounces,
                                  .next_event = next_event,
                                  .seed = l->job->options.occlusion.seed};
    return alpi_reference_irradiance(&paths, l->receivers, NULL, 0, NULL, l->values);
}

static double mean_variance(const light_pilot *l)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < l->pilot->count; i++) {
        sum += mean_of(l->values[i].variance);
    }
    return sum / l->pilot->count;
}

/// Paths that ask no light are timed: rays of a gatherer ask none either.
static alp_result time_rays(const light_pilot *l)
{
    const stopwatch began = start_watch();
    ALP_TRY(send_paths(l, l->job->scene, l->lighting, 1, false));
    const double paths = (double)l->pilot->count * ALPI_PILOT_RAYS;
    l->pilot->path_seconds = read_watch(l->job, &began) / paths;
    l->pilot->ray_seconds = PACKET_SHARE * l->pilot->path_seconds;
    return ALP_OK;
}

/// The soft part of a sky alone: emissive surfaces that rays meet are direct light's.
static alp_result send_to_sky(const light_pilot *l)
{
    alp_scene dark;
    ALP_TRY(alpi_scene_without_emitters(l->job->scene, &dark));
    const alp_result result = send_paths(l, &dark, l->soft, 0, false);
    alpi_scene_without_emitters_clear(&dark);
    return result;
}

/// What rays will gather: bounced light, which is what a bounce adds to the variance, and the soft
/// part of a sky.
static alp_result light_by_bounces(const light_pilot *l)
{
    alpi_pilot *p = l->pilot;
    ALP_TRY(time_rays(l));
    ALP_TRY(send_paths(l, l->job->scene, l->lighting, 1, true));
    for (uint32_t i = 0; i < p->count; i++) {
        p->once_bounced += mean_of(l->values[i].mean) / p->count;
    }
    double variance = mean_variance(l);
    ALP_TRY(send_paths(l, l->job->scene, l->lighting, 0, true));
    variance -= mean_variance(l);
    if (l->soft != NULL) {
        ALP_TRY(send_to_sky(l));
        variance += mean_variance(l);
    }
    p->bounced_error = sqrt(fmax(variance, 0.0));
    return ALP_OK;
}

static alp_result light_points(light_pilot *l)
{
    const alp_light_options *o = &l->job->options.light;
    const bool gathered = o->bounces > 0 && o->gather != ALP_GATHER_PATHS && l->job->only == NULL;
    if (gathered && alpi_lighting_sky(l->lighting) != NULL && !alpi_tracer_has_panes(l->tracer)) {
        ALP_TRY(alpi_lighting_split_sky(l->lighting, &o->lighting, &l->soft, &l->spots));
    }
    ALP_TRY(light_directly(l));
    return light_by_bounces(l);
}

static alp_result run_light(const alpi_bake_job *job, const alpi_tracer *tracer, double area,
                            alpi_pilot *pilot)
{
    alpi_lighting *lighting = NULL;
    alpi_point_array points;
    ALP_TRY(alpi_lighting_create_quietly(job->scene, &job->options.light.lighting, &lighting));
    alp_result result = alpi_point_array_create(job->context, ALPI_PILOT_POINTS, &points);
    alpi_reference_value *values = ALPI_NEW(job->context, alpi_reference_value, ALPI_PILOT_POINTS);
    if (result == ALP_OK && values != NULL) {
        place_points(job, area, 0.0, 1, &points);
        alpi_receivers receivers = alpi_point_array_receivers(&points);
        receivers.extended = true; // each sample asks lamps, as one of a texel does
        light_pilot l = {.job = job,
                         .receivers = &receivers,
                         .tracer = tracer,
                         .lighting = lighting,
                         .values = values,
                         .pilot = pilot};
        pilot->count = points.count;
        result = points.count > 0 ? light_points(&l) : ALP_OK;
        alpi_lighting_destroy(job->context, l.soft);
        alpi_lighting_destroy(job->context, l.spots);
    }
    result = result == ALP_OK && values == NULL ? ALP_ERROR_OUT_OF_MEMORY : result;
    alpi_release(job->context, values);
    alpi_point_array_destroy(job->context, &points);
    alpi_lighting_destroy(job->context, lighting);
    return result;
}

// --- occlusion -----------------------------------------------------------------------------------

static alp_result shade_points(const alpi_bake_job *job, const alpi_occlusion_setup *setup,
                               const alpi_receivers *receivers, alpi_pilot *p)
{
    alpi_occlusion_sums sums;
    ALP_TRY(alpi_occlusion_sums_create(setup->context, receivers->count, false, &sums));
    const stopwatch began = start_watch();
    const alp_result result = alpi_occlusion_add(setup, receivers, NULL, receivers->count, 0,
                                                 setup->samples, setup->samples, NULL, &sums);
    const double rays = (double)receivers->count * setup->samples;
    p->occlusion_seconds = read_watch(job, &began) / rays;
    double mean = 0.0, variance = 0.0;
    for (uint32_t i = 0; i < receivers->count; i++) {
        mean += (double)alpi_occlusion_value(&sums, i) / receivers->count;
        variance += alpi_spread_variance(&sums, i) / receivers->count;
    }
    p->occlusion_error = mean > 0.0 ? sqrt(variance) / (SPREAD_OVER_ERROR * mean) : 0.0;
    alpi_occlusion_sums_destroy(setup->context, &sums);
    return result;
}

static alp_result run_occlusion(const alpi_bake_job *job, const alpi_tracer *tracer, double area,
                                double texel, alpi_pilot *pilot)
{
    alpi_point_array points;
    alpi_occlusion_setup setup;
    alp_occlusion_options options = job->options.occlusion;
    options.samples = ALPI_PILOT_RAYS;
    ALP_TRY(alpi_point_array_create(job->context, BLOCKS * BLOCK, &points));
    place_points(job, area, texel, BLOCK, &points);
    alp_result result = alpi_occlusion_prepare(job->scene, tracer, &options, &setup);
    if (result == ALP_OK) {
        const alpi_receivers receivers = alpi_point_array_receivers(&points);
        result = points.count > 0 ? shade_points(job, &setup, &receivers, pilot) : ALP_OK;
        alpi_occlusion_release(&setup);
    }
    alpi_point_array_destroy(job->context, &points);
    return result;
}

alp_result alpi_pilot_run(const alpi_bake_job *job, double area, double texel, alpi_pilot *pilot)
{
    const alp_bake_options *o = &job->options;
    alpi_tracer *tracer = NULL, *owned = NULL;
    *pilot = (alpi_pilot){.count = 0};
    ALP_TRY(alpi_bake_tracer(job, o->progress, o->progress_user, &tracer, &owned));
    alp_result result = ALP_OK;
    if ((o->maps & ALP_MAP_LIGHT) != 0) {
        result = run_light(job, tracer, area, pilot);
    }
    if (result == ALP_OK && alpi_bake_wants_occlusion(&job->options)) {
        result = run_occlusion(job, tracer, area, texel, pilot);
    }
    alpi_tracer_destroy(owned);
    return result;
}
