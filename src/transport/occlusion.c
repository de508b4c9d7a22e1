// SPDX-License-Identifier: MIT
// Ambient occlusion by rays: accessibility A = 1 − E[w(t)] over directions in a cone about the
// shading normal, t = distance of the hit over the distance limit. Based on: Zhukov, Iones, Kronin.
// An Ambient Light Illumination Model. EGWR 1998;
//           I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU 2007.
#include "transport/occlusion.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "base/warp.h"

#include <math.h>

// Work is cut so that one range takes a few milliseconds and cancelling stays prompt.
enum { RAYS_PER_RANGE = 1 << 14, SAMPLES_PER_ROUND = 1 << 16, SAMPLE_LIMIT = 1 << 20 };

static const float DISTANCE_AUTO_SHARE = 0.2f; // of the bounding box's diagonal

alp_occlusion_options alp_occlusion_options_default(void)
{
    return (alp_occlusion_options){.struct_size = sizeof(alp_occlusion_options),
                                   .samples = 512,
                                   .falloff = ALP_FALLOFF_SMOOTH,
                                   .cone = (float)(ALPI_PI / 2.0)};
}

float alp_occlusion_distance(const alp_scene *scene, const alp_occlusion_options *options)
{
    if (scene == NULL || options == NULL || options->distance != 0.0f) {
        return options ? options->distance : 0.0f;
    }
    return DISTANCE_AUTO_SHARE * vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
}

alp_result alpi_occlusion_check(const alp_scene *scene, const alp_occlusion_options *o)
{
    alp_context *context = scene->context;
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (o->struct_size != sizeof *o) {
        return alpi_fail(context, code, "occlusion options are not from _default()");
    }
    if (o->samples < 1 || o->samples > SAMPLE_LIMIT) {
        return alpi_fail(context, code, "occlusion: %u samples, need 1 to %d", o->samples,
                         SAMPLE_LIMIT);
    }
    if (!(o->distance >= 0.0f)) {
        return alpi_fail(context, code, "occlusion: distance %g m, need > 0, or 0 for automatic",
                         (double)o->distance);
    }
    if (!(o->cone > 0.0f) || o->cone > (float)(ALPI_PI / 2.0) * 1.000001f) {
        return alpi_fail(context, code, "occlusion: cone half-angle %g rad, need (0, pi/2]",
                         (double)o->cone);
    }
    if ((int)o->falloff < ALP_FALLOFF_NONE || o->falloff > ALP_FALLOFF_EXP ||
        (int)o->distribution < ALP_DISTRIBUTION_COSINE ||
        o->distribution > ALP_DISTRIBUTION_UNIFORM) {
        return alpi_fail(context, code, "occlusion: unknown fall-off or distribution");
    }
    return ALP_OK;
}

alpi_occlusion_setup alpi_occlusion_prepare(const alp_scene *scene, const alpi_tracer *tracer,
                                            const alp_occlusion_options *options)
{
    bool hemisphere = options->cone >= (float)(ALPI_PI / 2.0) * 0.999999f;
    float s = sinf(options->cone);
    return (alpi_occlusion_setup){
        .tracer = tracer,
        .options = *options,
        .distance = alp_occlusion_distance(scene, options),
        .cone_sin2 = hemisphere ? 1.0f : s * s,
        .cone_cos = hemisphere ? 0.0f : cosf(options->cone),
        .filter = {.one_sided = options->one_sided},
    };
}

/// How much a hit at t in [0, 1] occludes.
static float falloff_weight(alp_falloff falloff, float t)
{
    float rest = 1.0f - t;
    switch (falloff) {
    case ALP_FALLOFF_LINEAR:
        return rest;
    case ALP_FALLOFF_SMOOTH:
        return rest * rest * (1.0f + 2.0f * t);
    case ALP_FALLOFF_EXP: {
        const float end = 0.018315638889f; // e^−4
        return (expf(-4.0f * t) - end) / (1.0f - end);
    }
    case ALP_FALLOFF_NONE:
    default:
        return 1.0f;
    }
}

static uint32_t count_bits(uint32_t bits)
{
    return (uint32_t)__builtin_popcount(bits);
}

/// Fills the directions of samples [first, first + 8) in the frame (t, b, n).
static void fill_directions(const alpi_occlusion_setup *setup, uint32_t key, uint32_t first, vec3 n,
                            alpi_rays *rays)
{
    vec3 t, b;
    vec3_frame(n, &t, &b);
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        vec2 u = alpi_sample_2d(key, first + i);
        vec3 local = setup->options.distribution == ALP_DISTRIBUTION_UNIFORM
                         ? alpi_warp_uniform_cone(u, setup->cone_cos)
                         : alpi_warp_cosine_cone(u, setup->cone_sin2);
        rays->direction_x[i] = local.x * t.x + local.y * b.x + local.z * n.x;
        rays->direction_y[i] = local.x * t.y + local.y * b.y + local.z * n.y;
        rays->direction_z[i] = local.x * t.z + local.y * b.z + local.z * n.z;
    }
}

/// Σ w of the active lanes of one packet, in lane order.
static double packet_sum(const alpi_occlusion_setup *setup, const alpi_rays *rays, uint32_t active)
{
    alp_falloff falloff = setup->options.falloff;
    if (falloff == ALP_FALLOFF_NONE || isinf(setup->distance)) {
        return (double)count_bits(alpi_trace_occluded(setup->tracer, rays, active, setup->filter));
    }
    alpi_hits hits;
    alpi_trace_nearest(setup->tracer, rays, active, setup->filter, &hits);
    double sum = 0.0;
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        if ((active >> i & 1u) != 0 && hits.triangle[i] != ALPI_NONE) {
            float t = fminf(hits.distance[i] / setup->distance, 1.0f);
            sum += (double)falloff_weight(falloff, t);
        }
    }
    return sum;
}

double alpi_occlusion_sum(const alpi_occlusion_setup *setup, const alpi_receiver *receiver,
                          uint32_t first, uint32_t count)
{
    uint32_t key = alpi_random_key(setup->options.seed, receiver->key, 0);
    vec3 origin = vec3_mad(receiver->position, receiver->offset, receiver->geometric_normal);
    alpi_rays rays;
    for (int i = 0; i < ALPI_PACKET; i++) {
        rays.origin_x[i] = origin.x;
        rays.origin_y[i] = origin.y;
        rays.origin_z[i] = origin.z;
        rays.minimum[i] = 0.0f;
        rays.maximum[i] = setup->distance;
    }
    double sum = 0.0;
    for (uint32_t done = 0; done < count; done += ALPI_PACKET) {
        uint32_t lanes = count - done < ALPI_PACKET ? count - done : ALPI_PACKET;
        fill_directions(setup, key, first + done, receiver->shading_normal, &rays);
        sum += packet_sum(setup, &rays, (1u << lanes) - 1u);
    }
    return sum;
}

// --- all receivers -------------------------------------------------------------------------------

/// One round: a run of samples for every receiver.
typedef struct round_job {
    const alpi_occlusion_setup *setup;
    const alpi_receivers *receivers;
    const uint32_t *list;
    double *sums; // [list_count]
    uint32_t first_sample, sample_count;
} round_job;

static alp_result run_round(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const round_job *job = user;
    const alpi_receivers *r = job->receivers;
    for (uint32_t i = begin; i < end; i++) {
        const float center[1][2] = {{0.5f, 0.5f}};
        uint32_t index = job->list != NULL ? job->list[i] : i;
        alpi_receiver_point point;
        r->place(r->user, index, 1, center, &point);
        alpi_receiver receiver = {index, point.position, point.geometric_normal,
                                  point.shading_normal, point.offset};
        job->sums[i] +=
            alpi_occlusion_sum(job->setup, &receiver, job->first_sample, job->sample_count);
    }
    return ALP_OK;
}

alp_result alpi_occlusion_gather(alp_context *context, const alpi_occlusion_setup *setup,
                                 const alpi_receivers *receivers, const uint32_t *list,
                                 uint32_t list_count, float *accessibility)
{
    double *sums = ALPI_NEW(context, double, list_count);
    if (sums == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    uint32_t samples = setup->options.samples;
    double started = alpi_seconds();
    alp_result result = ALP_OK;
    for (uint32_t first = 0; first < samples && result == ALP_OK; first += SAMPLES_PER_ROUND) {
        uint32_t count = samples - first < SAMPLES_PER_ROUND ? samples - first : SAMPLES_PER_ROUND;
        round_job job = {setup, receivers, list, sums, first, count};
        alpi_task_progress progress = {
            .callback = setup->options.progress,
            .user = setup->options.progress_user,
            .stage = "occlusion",
            .units_per_item = (double)count,
            .units_before = (double)first * (double)list_count,
            .units_total = (double)samples * (double)list_count,
            .started = started,
            .units_are_rays = true,
        };
        uint32_t grain = RAYS_PER_RANGE / count;
        result = alpi_parallel_for(context, list_count, grain > 0 ? grain : 1, run_round, &job,
                                   &progress);
    }
    for (uint32_t i = 0; result == ALP_OK && i < list_count; i++) {
        accessibility[list != NULL ? list[i] : i] = (float)(1.0 - sums[i] / (double)samples);
    }
    alpi_release(context, sums);
    return result;
}

// --- public --------------------------------------------------------------------------------------

static bool is_unit(const float n[3])
{
    return fabsf(vec3_length(vec3_load(n)) - 1.0f) < 1e-3f; // NaN compares false
}

/// Largest absolute coordinate of the scene.
static float scene_reach(const alp_scene *scene)
{
    vec3 a = scene->bounds_min, b = scene->bounds_max;
    float low = fmaxf(fmaxf(fabsf(a.x), fabsf(a.y)), fabsf(a.z));
    float high = fmaxf(fmaxf(fabsf(b.x), fabsf(b.y)), fabsf(b.z));
    return fmaxf(low, high);
}

typedef struct offset_job {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    const alpi_point_array *points;
} offset_job;

/// Points come without the triangle they lie on, which their offset depends on: looks for it with
/// one short ray down through each point. A point on no surface needs no lift beyond its own
/// rounding.
static alp_result find_offsets(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const offset_job *job = user;
    const alp_scene *scene = job->scene;
    const alpi_point_array *r = job->points;
    float reach = 8.0f * 0x1p-23f * scene_reach(scene);
    for (uint32_t i = begin; i < end; i++) {
        vec3 p = vec3_load(r->positions[i]), n = vec3_load(r->geometric_normals[i]);
        vec3 start = vec3_mad(p, reach, n);
        alpi_rays ray = {.origin_x = {start.x},
                         .origin_y = {start.y},
                         .origin_z = {start.z},
                         .direction_x = {-n.x},
                         .direction_y = {-n.y},
                         .direction_z = {-n.z},
                         .maximum = {2.0f * reach}};
        alpi_hits hit;
        vec3 corners[3];
        alpi_trace_nearest(job->tracer, &ray, 1u, (alpi_trace_filter){0}, &hit);
        if (hit.triangle[0] != ALPI_NONE) {
            alpi_triangle_corners(scene, hit.triangle[0], corners);
        }
        r->offsets[i] = alpi_receiver_offset(p, hit.triangle[0] != ALPI_NONE ? corners : NULL);
    }
    return ALP_OK;
}

static alp_result copy_points(alp_context *context, const float *positions,
                              const float *geometric_normals, const float *shading_normals,
                              alpi_point_array *r)
{
    const float *geometric = geometric_normals ? geometric_normals : shading_normals;
    for (uint32_t i = 0; i < r->count; i++) {
        for (int k = 0; k < 3; k++) {
            r->positions[i][k] = positions[3 * (size_t)i + (size_t)k];
            r->geometric_normals[i][k] = geometric[3 * (size_t)i + (size_t)k];
            r->shading_normals[i][k] = shading_normals[3 * (size_t)i + (size_t)k];
        }
        if (!vec3_is_finite(vec3_load(r->positions[i])) || !is_unit(r->geometric_normals[i]) ||
            !is_unit(r->shading_normals[i])) {
            return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                             "point %u: its position is not finite or a normal is not unit length",
                             i);
        }
    }
    return ALP_OK;
}

static alp_result gather_points(alp_context *context, const alpi_occlusion_setup *setup,
                                const alpi_point_array *points, float *accessibility)
{
    const alpi_receivers receivers = alpi_point_array_receivers(points);
    return alpi_occlusion_gather(context, setup, &receivers, NULL, points->count, accessibility);
}

alp_result alp_occlusion_at_points(const alp_scene *scene, uint32_t count, const float *positions,
                                   const float *geometric_normals, const float *shading_normals,
                                   const alp_occlusion_options *options, float *accessibility)
{
    if (scene == NULL ||
        (count > 0 && (positions == NULL || shading_normals == NULL || accessibility == NULL))) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    alp_occlusion_options o = options ? *options : alp_occlusion_options_default();
    ALP_TRY(alpi_occlusion_check(scene, &o));
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(scene, o.progress, o.progress_user, &tracer, NULL));
    alpi_occlusion_setup setup = alpi_occlusion_prepare(scene, tracer, &o);
    alpi_point_array points;
    ALP_TRY(alpi_point_array_create(scene->context, count, &points));
    alp_result result =
        copy_points(scene->context, positions, geometric_normals, shading_normals, &points);
    if (result == ALP_OK) {
        offset_job job = {scene, tracer, &points};
        const alpi_task_progress progress = {
            .callback = o.progress, .user = o.progress_user, .stage = "offsets"};
        result =
            alpi_parallel_for(scene->context, count, RAYS_PER_RANGE, find_offsets, &job, &progress);
    }
    if (result == ALP_OK) {
        result = gather_points(scene->context, &setup, &points, accessibility);
    }
    alpi_point_array_destroy(scene->context, &points);
    return result;
}
