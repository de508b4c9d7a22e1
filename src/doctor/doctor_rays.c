// SPDX-License-Identifier: MIT
// Points spread over the scene, and rays from their sides.
#include "doctor/doctor_rays.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "base/warp.h"
#include "scene/receivers.h"

#include <math.h>

// --- rays ----------------------------------------------------------------------------------------

static vec3 place_of(const vec3 c[3], const alpi_area_point *point)
{
    const vec3 p = vec3_scale(c[0], 1.0f - point->b1 - point->b2);
    return vec3_mad(vec3_mad(p, point->b1, c[1]), point->b2, c[2]);
}

static vec3 face_normal(const vec3 c[3])
{
    return vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
}

static alpi_doctor_hit judge(const alp_scene *scene, const alpi_hits *hits, int lane,
                             vec3 direction)
{
    const uint32_t triangle = hits->triangle[lane];
    if (triangle == ALPI_NONE) {
        return (alpi_doctor_hit){.triangle = ALPI_NONE};
    }
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return (alpi_doctor_hit){.triangle = triangle,
                             .distance = hits->distance[lane],
                             .back =
                                 vec3_dot(face_normal(c), direction) > 0.0f &&
                                 !alpi_surface_is_double_sided(scene, triangle) &&
                                 !alpi_surface_is_pane(scene, scene->triangle_surface[triangle])};
}

void alpi_doctor_look(const alp_scene *scene, const alpi_tracer *tracer, const alpi_doctor_eye *eye,
                      uint32_t first, alpi_doctor_hit hits[ALPI_PACKET])
{
    vec3 t, b, directions[ALPI_PACKET];
    alpi_rays rays;
    alpi_hits met;
    alpi_rays_clear(&rays);
    vec3_frame(eye->normal, &t, &b);
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        const vec3 local = alpi_warp_cosine_cone(alpi_sample_2d(eye->key, first + i), 1.0f);
        const vec3 flat = vec3_mad(vec3_scale(t, local.x), local.y, b);
        directions[i] = vec3_normalize_or(vec3_mad(flat, local.z, eye->normal), eye->normal);
        alpi_rays_set(&rays, (int)i, eye->start, directions[i], (float)INFINITY);
    }
    alpi_trace_nearest(tracer, &rays, (1u << ALPI_PACKET) - 1u,
                       (alpi_trace_filter){.backs = eye->backs}, &met);
    for (int i = 0; i < ALPI_PACKET; i++) {
        hits[i] = judge(scene, &met, i, directions[i]);
    }
}

void alpi_doctor_look_from(const alpi_doctor_points *points, uint32_t point, float sign,
                           uint32_t stream, uint32_t first, alpi_doctor_hit hits[ALPI_PACKET])
{
    vec3 c[3];
    alpi_triangle_corners(points->scene, points->points[point].triangle, c);
    const vec3 normal = vec3_scale(face_normal(c), sign);
    const vec3 p = place_of(c, &points->points[point]);
    const alpi_doctor_eye eye = {vec3_mad(p, alpi_receiver_offset(p, c), normal), normal,
                                 alpi_random_key(0, point, stream), false};
    alpi_doctor_look(points->scene, points->tracer, &eye, first, hits);
}

void alpi_doctor_mark_point(alp_diagnosis *diagnosis, const alpi_area_point *point)
{
    vec3 c[3];
    alpi_triangle_corners(diagnosis->scene, point->triangle, c);
    alpi_diagnosis_mark(diagnosis, point->triangle, place_of(c, point), NULL);
}

// --- surveys -------------------------------------------------------------------------------------

typedef struct campaign {
    const alpi_doctor_survey *survey;
    const alpi_doctor_points *points;
    uint8_t *kept;
} campaign;

static alp_result look_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    const campaign *r = user;
    (void)worker;
    for (uint32_t i = begin; i < end; i++) {
        r->survey->look(r->points, i, r->kept + i * r->survey->size);
    }
    return ALP_OK;
}

alp_result alpi_doctor_take_survey(alp_diagnosis *diagnosis, const alpi_doctor_survey *survey)
{
    alp_context *context = diagnosis->context;
    const alp_scene *scene = diagnosis->scene;
    alpi_doctor_points p = {.scene = scene, .count = survey->point_count};
    if (scene->usable_count == 0) {
        return ALP_OK;
    }
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    p.tracer = tracer;
    p.points = ALPI_NEW(context, alpi_area_point, p.count);
    campaign r = {survey, &p, alpi_allocate(context, p.count, survey->size)};
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (p.points != NULL && r.kept != NULL) {
        result = ALP_OK;
        if (alpi_area_points(scene, p.count, p.points)) {
            result =
                alpi_parallel_for(context, p.count, survey->points_per_range, look_range, &r, NULL);
            result = result == ALP_OK ? survey->tell(diagnosis, &p, r.kept) : result;
        }
    }
    alpi_release(context, p.points);
    alpi_release(context, r.kept);
    return result;
}
