// SPDX-License-Identifier: MIT
// Ambient occlusion, bent normals and coloured obscurance at any array of points.
#include "transport/occlusion/obscurance.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>

enum { POINTS_PER_RANGE = 1 << 12 };

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

// --- what is asked for ---------------------------------------------------------------------------

/// Gathers one quantity at all points; `values` holds one or three floats for each.
typedef alp_result gather_fn(const alpi_occlusion_setup *setup, const alpi_point_array *points,
                             float *values);

static alp_result gather_accessibility(const alpi_occlusion_setup *setup,
                                       const alpi_point_array *points, float *values)
{
    const alpi_receivers receivers = alpi_point_array_receivers(points);
    return alpi_occlusion_gather(setup, &receivers, NULL, points->count, values);
}

static alp_result gather_obscurance(const alpi_occlusion_setup *setup,
                                    const alpi_point_array *points, float *values)
{
    const alpi_receivers receivers = alpi_point_array_receivers(points);
    const alpi_task_progress progress = {.callback = setup->options.progress,
                                         .user = setup->options.progress_user,
                                         .stage = "obscurance"};
    alpi_occlusion_sums sums;
    ALP_TRY(alpi_occlusion_sums_create(setup->context, points->count, true, &sums));
    alp_result result =
        alpi_obscurance_gather(setup, &receivers, NULL, points->count, setup->samples, &progress,
                               &sums, (float(*)[3])values);
    alpi_occlusion_sums_destroy(setup->context, &sums);
    return result;
}

static alp_result gather_bent(const alpi_occlusion_setup *setup, const alpi_point_array *points,
                              float *values)
{
    const alpi_receivers receivers = alpi_point_array_receivers(points);
    const alpi_task_progress progress = {.callback = setup->options.progress,
                                         .user = setup->options.progress_user,
                                         .stage = "occlusion"};
    alpi_occlusion_setup bent = *setup;
    bent.bent = true;
    alpi_occlusion_sums sums;
    ALP_TRY(alpi_occlusion_sums_create(setup->context, points->count, true, &sums));
    alp_result result = alpi_occlusion_add(&bent, &receivers, NULL, points->count, 0,
                                           setup->samples, setup->samples, &progress, &sums);
    for (uint32_t i = 0; i < points->count && result == ALP_OK; i++) {
        vec3_store(values + 3 * (size_t)i,
                   vec3_normalize_or(alpi_occlusion_mean_vector(&sums, i),
                                     vec3_load(points->shading_normals[i])));
    }
    alpi_occlusion_sums_destroy(setup->context, &sums);
    return result;
}

static alp_result prepare_and_gather(const alp_scene *scene, const alpi_tracer *tracer,
                                     const alp_occlusion_options *options,
                                     const alpi_point_array *points, gather_fn *gather,
                                     float *values)
{
    alpi_occlusion_setup setup;
    ALP_TRY(alpi_occlusion_prepare(scene, tracer, options, &setup));
    alp_result result = gather(&setup, points, values);
    alpi_occlusion_release(&setup);
    return result;
}

/// The points as callers give them.
typedef struct given_points {
    uint32_t count;
    const float *positions, *geometric_normals, *shading_normals;
} given_points;

static alp_result gather_at(const alp_scene *scene, given_points given,
                            const alp_occlusion_options *options, gather_fn *gather, float *values)
{
    const uint32_t count = given.count;
    if (scene == NULL || (count > 0 && (given.positions == NULL || given.shading_normals == NULL ||
                                        values == NULL))) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    alp_occlusion_options o = options ? *options : alp_occlusion_options_default();
    ALP_TRY(alpi_occlusion_check(scene, &o));
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(scene, o.progress, o.progress_user, &tracer, NULL));
    alpi_point_array points;
    ALP_TRY(alpi_point_array_create(scene->context, count, &points));
    alp_result result = copy_points(scene->context, given.positions, given.geometric_normals,
                                    given.shading_normals, &points);
    if (result == ALP_OK) {
        offset_job job = {scene, tracer, &points};
        const alpi_task_progress progress = {
            .callback = o.progress, .user = o.progress_user, .stage = "offsets"};
        result = alpi_parallel_for(scene->context, count, POINTS_PER_RANGE, find_offsets, &job,
                                   &progress);
    }
    if (result == ALP_OK) {
        result = prepare_and_gather(scene, tracer, &o, &points, gather, values);
    }
    alpi_point_array_destroy(scene->context, &points);
    return result;
}

alp_result alp_occlusion_at_points(const alp_scene *scene, uint32_t count, const float *positions,
                                   const float *geometric_normals, const float *shading_normals,
                                   const alp_occlusion_options *options, float *accessibility)
{
    const given_points given = {count, positions, geometric_normals, shading_normals};
    return gather_at(scene, given, options, gather_accessibility, accessibility);
}

alp_result alp_bent_normals_at_points(const alp_scene *scene, uint32_t count,
                                      const float *positions, const float *geometric_normals,
                                      const float *shading_normals,
                                      const alp_occlusion_options *options, float *bent_normals)
{
    const given_points given = {count, positions, geometric_normals, shading_normals};
    return gather_at(scene, given, options, gather_bent, bent_normals);
}

alp_result alp_obscurance_at_points(const alp_scene *scene, uint32_t count, const float *positions,
                                    const float *geometric_normals, const float *shading_normals,
                                    const alp_occlusion_options *options, float *obscurance)
{
    const given_points given = {count, positions, geometric_normals, shading_normals};
    return gather_at(scene, given, options, gather_obscurance, obscurance);
}
