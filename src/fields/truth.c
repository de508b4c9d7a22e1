// SPDX-License-Identifier: MIT
#include "fields/truth.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "base/warp.h"
#include "scene/lights/lighting.h"
#include "transport/sphere/sphere_rays.h"

#include <math.h>

enum { SAMPLE_LIMIT = 1 << 20 };
enum { STREAM_POSITION = 21, STREAM_HEIGHT = 22, STREAM_NORMAL = 23 };

alp_reference_options alp_reference_options_default(void)
{
    return (alp_reference_options){.struct_size = sizeof(alp_reference_options),
                                   .lighting = alp_lighting_options_default(),
                                   .bounces = ALP_BOUNCES_CONVERGE,
                                   .samples = 1024};
}

// --- reference -----------------------------------------------------------------------------------

static alp_result copy_points(alp_context *context, uint32_t count, const float (*positions)[3],
                              const float (*normals)[3], alpi_point_array *points)
{
    ALP_TRY(alpi_point_array_create(context, count, points));
    for (uint32_t i = 0; i < count; i++) {
        const vec3 p = vec3_load(positions[i]);
        const vec3 n = vec3_normalize_or(vec3_load(normals[i]), (vec3){0.0f, 1.0f, 0.0f});
        vec3_store(points->positions[i], p);
        vec3_store(points->geometric_normals[i], n);
        vec3_store(points->shading_normals[i], n);
        points->offsets[i] = alpi_receiver_offset(p, NULL);
    }
    return ALP_OK;
}

/// All light, and the part of it that counts where it arrives directly.
typedef struct light_pair {
    alpi_lighting *all, *direct;
} light_pair;

static alp_result trace_points(const alp_scene *scene, const alp_reference_options *o,
                               const alpi_point_array *points, const char *stage,
                               light_pair *lights, alpi_reference_value *values)
{
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(scene, o->progress, o->progress_user, &tracer, NULL));
    ALP_TRY(alpi_lighting_create(scene, &o->lighting, &lights->all));
    if (!o->direct) {
        ALP_TRY(alpi_lighting_create_without_lamps(scene, &o->lighting, &lights->direct));
    }
    const uint32_t limit = ALPI_REFERENCE_BOUNCE_LIMIT;
    const alpi_reference reference = {.context = scene->context,
                                      .scene = scene,
                                      .tracer = tracer,
                                      .lighting = lights->all,
                                      .direct = lights->direct,
                                      .bounces = o->bounces < limit ? o->bounces : limit,
                                      .samples = o->samples,
                                      .next_event = true,
                                      .seed = o->seed};
    const alpi_receivers receivers = alpi_point_array_receivers(points);
    const alpi_task_progress progress = {
        .callback = o->progress, .user = o->progress_user, .stage = stage, .units_are_rays = true};
    return alpi_reference_irradiance(&reference, &receivers, NULL, 0, &progress, values);
}

alp_result alpi_truth_at_points(const alp_scene *scene, const alp_reference_options *options,
                                uint32_t count, const float (*positions)[3],
                                const float (*normals)[3], const char *stage,
                                alpi_reference_value *values)
{
    alpi_point_array points;
    light_pair lights = {NULL, NULL};
    ALP_TRY(copy_points(scene->context, count, positions, normals, &points));
    const alp_result result = trace_points(scene, options, &points, stage, &lights, values);
    alpi_lighting_destroy(scene->context, lights.all);
    alpi_lighting_destroy(scene->context, lights.direct);
    alpi_point_array_destroy(scene->context, &points);
    return result;
}

static alp_result check_reference(const alp_scene *scene, const alp_reference_options *o)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (o->struct_size != sizeof *o) {
        return alpi_fail(scene->context, code, "reference options are not from _default()");
    }
    if (o->samples < 1 || o->samples > SAMPLE_LIMIT) {
        return alpi_fail(scene->context, code, "reference: %u samples per point, need 1 to %d",
                         o->samples, SAMPLE_LIMIT);
    }
    return alpi_lighting_refuse_darkness(scene, &o->lighting);
}

static alp_result check_points(const alp_scene *scene, uint32_t count, const float (*positions)[3],
                               const float (*normals)[3])
{
    for (uint32_t i = 0; i < count; i++) {
        const vec3 p = vec3_load(positions[i]), n = vec3_load(normals[i]);
        if (!vec3_is_finite(p) || !vec3_is_finite(n) || !(vec3_length(n) > 0.0f)) {
            return alpi_fail(
                scene->context, ALP_ERROR_INVALID_ARGUMENT,
                "point %u: position %g %g %g, normal %g %g %g: need finite numbers and "
                "a normal of some length",
                i, (double)p.x, (double)p.y, (double)p.z, (double)n.x, (double)n.y, (double)n.z);
        }
    }
    return ALP_OK;
}

alp_result alp_reference_irradiance(const alp_scene *scene, const alp_reference_options *options,
                                    uint32_t count, const float (*positions)[3],
                                    const float (*normals)[3], float (*irradiance)[3],
                                    float (*errors)[3])
{
    if (scene == NULL || irradiance == NULL || positions == NULL || normals == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    const alp_reference_options o = options ? *options : alp_reference_options_default();
    ALP_TRY(check_reference(scene, &o));
    ALP_TRY(check_points(scene, count, positions, normals));
    alpi_reference_value *values = ALPI_NEW(scene->context, alpi_reference_value, count);
    if (values == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result =
        alpi_truth_at_points(scene, &o, count, positions, normals, "reference", values);
    for (uint32_t i = 0; i < count && result == ALP_OK; i++) {
        for (int k = 0; k < 3; k++) {
            irradiance[i][k] = values[i].mean[k];
            if (errors != NULL) {
                errors[i][k] = sqrtf(values[i].variance[k]);
            }
        }
    }
    alpi_release(scene->context, values);
    return result;
}

// --- free points ---------------------------------------------------------------------------------

/// Where points are drawn: a box, and a ball that it may be cut to.
typedef struct draw_region {
    vec3 low, size;
    vec3 centre;
    float radius; // INFINITY: the whole box
} draw_region;

static draw_region scene_region(const alp_scene *scene)
{
    return (draw_region){.low = scene->bounds_min,
                         .size = vec3_sub(scene->bounds_max, scene->bounds_min),
                         .radius = INFINITY};
}

/// The part of a scene's bounds that lies in a ball. @return false: it is empty
static bool ball_region(const alp_scene *scene, vec3 centre, float radius, draw_region *region)
{
    const vec3 reach = {radius, radius, radius};
    const vec3 low = vec3_max(scene->bounds_min, vec3_sub(centre, reach));
    const vec3 high = vec3_min(scene->bounds_max, vec3_add(centre, reach));
    *region = (draw_region){low, vec3_sub(high, low), centre, radius};
    return low.x <= high.x && low.y <= high.y && low.z <= high.z;
}

/// Places of the sequence in the region, with random normals.
static void draw_points(const draw_region *region, uint64_t seed, uint32_t first, uint32_t count,
                        float (*positions)[3], float (*normals)[3])
{
    const uint32_t plan = alpi_random_key(seed, 0, STREAM_POSITION);
    const uint32_t height = alpi_random_key(seed, 0, STREAM_HEIGHT);
    const uint32_t normal = alpi_random_key(seed, 0, STREAM_NORMAL);
    const vec3 low = region->low, size = region->size;
    for (uint32_t i = 0; i < count; i++) {
        const vec2 at = alpi_sample_2d(plan, first + i), up = alpi_sample_2d(height, first + i);
        positions[i][0] = low.x + at.x * size.x;
        positions[i][1] = low.y + up.x * size.y;
        positions[i][2] = low.z + at.y * size.z;
        vec3_store(normals[i], alpi_warp_uniform_cone(alpi_sample_2d(normal, first + i), -1.0f));
    }
}

static bool in_ball(const draw_region *region, const float position[3])
{
    return vec3_length(vec3_sub(vec3_load(position), region->centre)) <= region->radius;
}

static alp_result find_free(const alp_scene *scene, const draw_region *region, uint64_t seed,
                            uint32_t count, float (*positions)[3], float (*normals)[3],
                            alpi_sphere_light *found)
{
    enum { ROUNDS = 64 };
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    const alpi_sphere_rays rays = {.context = scene->context,
                                   .from = {.scene = scene, .tracer = tracer},
                                   .face = 4,
                                   .replicates = ALPI_SPHERE_REPLICATES_LEAST,
                                   .reach = 1.0f,
                                   .seed = seed};
    uint32_t done = 0, drawn = 0;
    for (int round = 0; round < ROUNDS && done < count; round++) {
        const uint32_t more = count - done;
        draw_points(region, seed, drawn, more, positions + done, normals + done);
        const alpi_sphere_job job = {.rays = &rays,
                                     .points = (const float(*)[3])(positions + done),
                                     .count = more,
                                     .values = found};
        ALP_TRY(alpi_sphere_gather(&job, NULL));
        drawn += more;
        const uint32_t begin = done;
        for (uint32_t i = 0; i < more; i++) {
            if (found[i].behind <= ALPI_FREE_BACKS && in_ball(region, positions[begin + i])) {
                for (int k = 0; k < 3; k++) {
                    positions[done][k] = positions[begin + i][k];
                    normals[done][k] = normals[begin + i][k];
                }
                done++;
            }
        }
    }
    return done == count ? ALP_OK
                         : alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                                     "%s: no free point was found inside its bounds: everywhere "
                                     "rays meet the backs of surfaces; run info for faults",
                                     scene->name);
}

static alp_result free_points(const alp_scene *scene, const draw_region *region, uint64_t seed,
                              uint32_t count, float (*positions)[3], float (*normals)[3])
{
    alpi_sphere_light *found = ALPI_NEW(scene->context, alpi_sphere_light, count);
    if (found == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result = find_free(scene, region, seed, count, positions, normals, found);
    alpi_release(scene->context, found);
    return result;
}

alp_result alp_scene_free_points(const alp_scene *scene, uint64_t seed, uint32_t count,
                                 float (*positions)[3], float (*normals)[3])
{
    if (scene == NULL || positions == NULL || normals == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    const draw_region region = scene_region(scene);
    return free_points(scene, &region, seed, count, positions, normals);
}

alp_result alp_scene_free_points_near(const alp_scene *scene, const float centre[3], float radius,
                                      uint64_t seed, uint32_t count, float (*positions)[3],
                                      float (*normals)[3])
{
    if (scene == NULL || centre == NULL || positions == NULL || normals == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    draw_region region;
    if (!vec3_is_finite(vec3_load(centre)) || !(radius > 0.0f) || !isfinite(radius) ||
        !ball_region(scene, vec3_load(centre), radius, &region)) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "no free point: the ball of %g m about %g %g %g does not meet the scene",
                         (double)radius, (double)centre[0], (double)centre[1], (double)centre[2]);
    }
    return free_points(scene, &region, seed, count, positions, normals);
}
