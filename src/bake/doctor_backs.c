// SPDX-License-Identifier: MIT
// The doctor's look at backs: single-sided surfaces that other surfaces see from behind, found by
// rays from points spread over the scene.
#include "bake/doctor.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "base/warp.h"
#include "scene/area_points.h"
#include "scene/receivers.h"
#include "trace/trace.h"

#include <math.h>

/// 16 rays each: of 16384 a share of 10 % has a standard error of .2 %.
enum { POINTS = 1024, RAYS = 2 * ALPI_PACKET, POINTS_PER_RANGE = 32, STREAM_BACKS = 201 };
/// Share of what surfaces see from which backs are worth a word. In a good scene solids reach into
/// each other, and see out through their faces there: 5 % in builtin:atrium, 9 % in measured
/// models.
static const double BACKS_SHARE = 0.1;
/// Of all rays: where hardly any meet anything, shares say nothing.
static const double SEEN_SHARE = 0.01;
/// A point that sees so much of backs lies inside something: nobody sees it. In sixteenths.
enum { INSIDE = RAYS * 3 / 4 };

typedef struct survey {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    alpi_area_point points[POINTS];
    uint32_t hits[POINTS][RAYS]; // triangle met from behind, or one of these
} survey;
static const uint32_t NOTHING = ALPI_NONE, FRONT = ALPI_NONE - 1;

/// The place of a point, just above the front of its triangle.
static vec3 start_of(const alp_scene *scene, const alpi_area_point *point, vec3 *normal)
{
    vec3 c[3];
    alpi_triangle_corners(scene, point->triangle, c);
    *normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    vec3 p = vec3_scale(c[0], 1.0f - point->b1 - point->b2);
    p = vec3_mad(vec3_mad(p, point->b1, c[1]), point->b2, c[2]);
    return vec3_mad(p, alpi_receiver_offset(p, c), *normal);
}

static uint32_t judge(const alp_scene *scene, const alpi_hits *hits, int lane, vec3 direction)
{
    const uint32_t triangle = hits->triangle[lane];
    if (triangle == ALPI_NONE) {
        return NOTHING;
    }
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    const vec3 face = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    const uint32_t surface = scene->triangle_surface[triangle];
    return vec3_dot(face, direction) > 0.0f && !alpi_surface_is_double_sided(scene, triangle) &&
                   !alpi_surface_is_pane(scene, surface)
               ? triangle
               : FRONT;
}

static void look_from(survey *s, uint32_t point)
{
    vec3 normal, t, b, directions[ALPI_PACKET];
    const vec3 start = start_of(s->scene, &s->points[point], &normal);
    vec3_frame(normal, &t, &b);
    for (uint32_t first = 0; first < RAYS; first += ALPI_PACKET) {
        alpi_rays rays;
        alpi_hits hits;
        alpi_rays_clear(&rays);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            const vec3 local = alpi_warp_cosine_cone(
                alpi_sample_2d(alpi_random_key(0, point, STREAM_BACKS), first + i), 1.0f);
            directions[i] = vec3_normalize_or(
                vec3_mad(vec3_mad(vec3_scale(t, local.x), local.y, b), local.z, normal), normal);
            alpi_rays_set(&rays, (int)i, start, directions[i], (float)INFINITY);
        }
        alpi_trace_nearest(s->tracer, &rays, (1u << ALPI_PACKET) - 1u,
                           (alpi_trace_filter){.one_sided = false}, &hits);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            s->hits[point][first + i] = judge(s->scene, &hits, (int)i, directions[i]);
        }
    }
}

static alp_result look_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    for (uint32_t i = begin; i < end; i++) {
        look_from(user, i);
    }
    return ALP_OK;
}

/// Adds up what was seen; of backs, `counts` has each surface's, `first` a triangle of it.
static void add_up(const survey *s, uint32_t *counts, uint32_t *first, uint32_t *seen,
                   uint32_t *backs)
{
    for (uint32_t p = 0; p < POINTS; p++) {
        uint32_t own = 0;
        for (uint32_t i = 0; i < RAYS; i++) {
            own += s->hits[p][i] < FRONT;
        }
        for (uint32_t i = 0; own < INSIDE && i < RAYS; i++) {
            const uint32_t hit = s->hits[p][i];
            *seen += hit != NOTHING;
            if (hit < FRONT) {
                const uint32_t surface = s->scene->triangle_surface[hit];
                first[surface] = counts[surface]++ == 0 ? hit : first[surface];
                *backs += 1;
            }
        }
    }
}

static alp_result tell(alp_diagnosis *d, const survey *s)
{
    const alp_scene *scene = d->scene;
    uint32_t *counts = ALPI_NEW(d->context, uint32_t, scene->surface_count);
    uint32_t *first = ALPI_NEW(d->context, uint32_t, scene->surface_count);
    if (counts == NULL || first == NULL) {
        alpi_release(d->context, counts);
        alpi_release(d->context, first);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    uint32_t seen = 0, backs = 0, most = 0;
    alp_result result = ALP_OK;
    add_up(s, counts, first, &seen, &backs);
    for (uint32_t i = 0; i < scene->surface_count; i++) {
        most = counts[i] > counts[most] ? i : most;
    }
    const double share = seen > 0 ? (double)backs / seen : 0.0;
    if (share >= BACKS_SHARE && seen >= SEEN_SHARE * POINTS * RAYS) {
        const alpi_finding_facts facts = {ALP_FINDING_BACKS_SEEN, ALP_PLACE_SURFACE, most, 0,
                                          share};
        result = alpi_diagnosis_add(d, facts,
                                    "%.3g %% of what surfaces see of others are backs of "
                                    "single-sided ones, this one most of all",
                                    100.0 * share);
        if (result == ALP_OK) {
            alpi_diagnosis_mark_triangle(d, first[most]);
        }
    }
    alpi_release(d->context, counts);
    alpi_release(d->context, first);
    return result;
}

alp_result alpi_doctor_look_at_backs(alp_diagnosis *diagnosis)
{
    const alp_scene *scene = diagnosis->scene;
    if (scene->usable_count == 0) {
        return ALP_OK;
    }
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    survey *s = ALPI_NEW(diagnosis->context, survey, 1);
    if (s == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    s->scene = scene;
    s->tracer = tracer;
    alp_result result = ALP_OK;
    if (alpi_area_points(scene, POINTS, s->points)) {
        result =
            alpi_parallel_for(diagnosis->context, POINTS, POINTS_PER_RANGE, look_range, s, NULL);
        result = result == ALP_OK ? tell(diagnosis, s) : result;
    }
    alpi_release(diagnosis->context, s);
    return result;
}
