// SPDX-License-Identifier: MIT
// Points on surfaces themselves: those that shine, with the first reflection of their light, and
// those that block. Triangles get points in proportion to their weight: the points of all
// triangles are one even sequence, and each triangle takes those that fall into its share.
#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "base/warp.h"
#include "fields/propagation/lpv_maps.h"
#include "scene/lights/lighting_emitters.h"
#include "transport/paths/hit.h"

#include <math.h>

enum { STREAM_POINT = 32, STREAM_RAY = 33 };

/// A point of a triangle. @param u [0, 1)²
static vec3 place_on(const vec3 c[3], vec2 u, float *b1, float *b2)
{
    const float root = sqrtf(u.x);
    *b1 = root * (1.0f - u.y);
    *b2 = root * u.y;
    vec3 p = vec3_scale(c[0], 1.0f - *b1 - *b2);
    p = vec3_mad(p, *b1, c[1]);
    return vec3_mad(p, *b2, c[2]);
}

/// Points of double-sided surfaces lie at the same places on both sides. They face one side and the
/// other in turn over all triangles, for a triangle may have a single point.
static vec2 sample_place(uint32_t key, uint32_t number, bool both)
{
    return alpi_sample_2d(key, both ? number / 2 : number);
}

static vec3 normal_at(const alp_scene *scene, uint32_t triangle, const vec3 c[3], float b1,
                      float b2)
{
    const vec3 flat = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    const uint32_t *v = scene->triangles[triangle];
    vec3 n = vec3_scale(vec3_load(scene->normals[v[0]]), 1.0f - b1 - b2);
    n = vec3_mad(n, b1, vec3_load(scene->normals[v[1]]));
    n = vec3_normalize_or(vec3_mad(n, b2, vec3_load(scene->normals[v[2]])), flat);
    return vec3_dot(n, flat) > 0.0f ? n : flat;
}

/// One of the points that are spread over triangles: `number` of those of its triangle.
typedef struct spread_point {
    uint32_t triangle, number;
    double weight; // of the triangle, over all points
} spread_point;

/// Gives each of [count] points its triangle.
/// @param triangles [n], NULL = 0 … n − 1   @param ends [n] running sums of weights, the last > 0
static void spread(const uint32_t *triangles, const double *ends, uint32_t n, uint32_t count,
                   spread_point *points)
{
    const double step = ends[n - 1] / count;
    uint32_t t = 0, number = 0;
    for (uint32_t i = 0; i < count; i++) {
        const double at = (i + 0.5) * step;
        for (; t + 1 < n && ends[t] <= at; t++) {
            number = 0;
        }
        points[i] = (spread_point){triangles != NULL ? triangles[t] : t, number++,
                                   t > 0 ? ends[t] - ends[t - 1] : ends[0]};
    }
}

static double triangle_area(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_triangle_area(c[0], c[1], c[2]);
}

// --- surfaces that block -------------------------------------------------------------------------

typedef struct point_job {
    const alpi_map_scene *in;
    const spread_point *points;
    double step; // of the running sums
    alpi_surfels *surfels;
    uint32_t count;
} point_job;

static alp_result place_blockers(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const point_job *job = user;
    const alp_scene *scene = job->in->scene;
    alpi_surfels *s = job->surfels;
    for (uint32_t i = begin; i < end; i++) {
        const spread_point *p = &job->points[i];
        const uint32_t key = alpi_random_key(job->in->seed, p->triangle, STREAM_POINT);
        vec3 c[3];
        float b1, b2;
        alpi_triangle_corners(scene, p->triangle, c);
        const bool both = alpi_surface_is_double_sided(scene, p->triangle);
        vec3_store(s->positions[i], place_on(c, sample_place(key, p->number, both), &b1, &b2));
        const vec3 n = normal_at(scene, p->triangle, c, b1, b2);
        vec3_store(s->normals[i], both && i % 2 == 1 ? vec3_scale(n, -1.0f) : n);
        vec3_store(s->albedo[i], alpi_surface_albedo(scene, p->triangle, b1, b2));
        s->areas[i] = alpi_surface_is_cut(scene, p->triangle, b1, b2)
                          ? 0.0f
                          : (float)(both ? 2.0 * job->step : job->step);
        s->radii[i] = job->in->radii[scene->triangle_surface[p->triangle]];
    }
    return ALP_OK;
}

static alp_result spread_all(const alpi_map_scene *in, alpi_surfels *surfels, double *ends,
                             spread_point *points)
{
    const alp_scene *scene = in->scene;
    double sum = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        sum += scene->triangle_usable[t] ? triangle_area(scene, t) : 0.0;
        ends[t] = sum;
    }
    if (!(sum > 0.0)) {
        return ALP_OK;
    }
    spread(NULL, ends, scene->triangle_count, surfels->count, points);
    point_job job = {in, points, sum / surfels->count, surfels, surfels->count};
    return alpi_parallel_for(scene->context, surfels->count, 1024, place_blockers, &job, NULL);
}

alp_result alpi_spread_points(const alpi_map_scene *in, alpi_surfels *surfels)
{
    alp_context *context = in->scene->context;
    double *ends = ALPI_NEW(context, double, in->scene->triangle_count);
    spread_point *points = ALPI_NEW(context, spread_point, surfels->count);
    const alp_result result = ends == NULL || points == NULL
                                  ? ALP_ERROR_OUT_OF_MEMORY
                                  : spread_all(in, surfels, ends, points);
    alpi_release(context, ends);
    alpi_release(context, points);
    return result;
}

// --- surfaces that shine -------------------------------------------------------------------------

/// A point that shines, as the surface there is.
typedef struct emitter_point {
    vec3 corners[3], position, normal, flux;
} emitter_point;

/// A point stands for weight × area: flux π L area.
static emitter_point find_emitter(const point_job *job, uint32_t i)
{
    const alp_scene *scene = job->in->scene;
    const spread_point *p = &job->points[i];
    const uint32_t key = alpi_random_key(job->in->seed, p->triangle, STREAM_POINT);
    emitter_point e;
    float b1, b2;
    alpi_triangle_corners(scene, p->triangle, e.corners);
    const vec3 *c = e.corners;
    const bool both = alpi_surface_is_double_sided(scene, p->triangle);
    const bool back = both && i % 2 == 1;
    const vec3 flat = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    e.position = place_on(c, sample_place(key, p->number, both), &b1, &b2);
    e.normal = back ? vec3_scale(flat, -1.0f) : flat;
    // Area of the triangle over its share of points, twice where only half of them see a side.
    const double area = triangle_area(scene, p->triangle) * job->step / p->weight;
    e.flux = vec3_scale(alpi_surface_emission(scene, p->triangle, b1, b2, e.normal),
                        (float)(ALPI_PI * area * (both ? 2.0 : 1.0)));
    return e;
}

/// The surface that a ray from a point meets reflects its flux, as surfel i.
static void reflect_flux(const point_job *job, const spread_point *p, const emitter_point *e,
                         uint32_t i)
{
    const alp_scene *scene = job->in->scene;
    alpi_surfels *s = job->surfels;
    vec3 t, b;
    vec3_frame(e->normal, &t, &b);
    const uint32_t key = alpi_random_key(job->in->seed, p->triangle, STREAM_RAY);
    const vec3 d = alpi_warp_cosine_cone(alpi_sample_2d(key, p->number), 1.0f);
    const vec3 way = vec3_mad(vec3_mad(vec3_scale(e->normal, d.z), d.x, t), d.y, b);
    const float offset = alpi_receiver_offset(e->position, e->corners);
    alpi_rays rays;
    alpi_hits hits;
    alpi_rays_clear(&rays);
    alpi_rays_set(&rays, 0, vec3_mad(e->position, offset, e->normal), way, INFINITY);
    alpi_trace_nearest(job->in->tracer, &rays, 1u, (alpi_trace_filter){0}, &hits);
    bool behind;
    if (hits.triangle[0] == ALPI_NONE) {
        return;
    }
    const uint32_t met = hits.triangle[0];
    const alpi_receiver_point hit = alpi_hit_point(scene, &hits, 0, way, &behind);
    if (behind && !alpi_surface_is_double_sided(scene, met)) {
        return;
    }
    const vec3 rho = alpi_surface_albedo(scene, met, hits.b1[0], hits.b2[0]);
    vec3_store(s->positions[i], hit.position);
    vec3_store(s->normals[i], hit.shading_normal);
    vec3_store(s->flux[i], (vec3){rho.x * e->flux.x, rho.y * e->flux.y, rho.z * e->flux.z});
    s->radii[i] = job->in->radii[scene->triangle_surface[met]];
}

/// The point itself, and what its ray meets.
static void shine(const point_job *job, uint32_t i)
{
    alpi_surfels *s = job->surfels;
    const emitter_point e = find_emitter(job, i);
    vec3_store(s->positions[i], e.position);
    vec3_store(s->normals[i], e.normal);
    vec3_store(s->flux[i], e.flux);
    s->radii[i] = 0.0f; // a small lamp gives all its light
    reflect_flux(job, &job->points[i], &e, i + job->count);
}

static alp_result shine_all(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const point_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        shine(job, i);
    }
    return ALP_OK;
}

static alp_result trace_list(const alpi_map_scene *in, const alpi_emitters *emitters, double *ends,
                             spread_point *points, alpi_surfels *surfels, bool *found)
{
    const alp_scene *scene = in->scene;
    const uint32_t count = surfels->count / 2;
    double sum = 0.0;
    for (uint32_t i = 0; i < emitters->count; i++) {
        const uint32_t t = emitters->triangles[i];
        sum += triangle_area(scene, t) * alpi_emitters_radiance(scene, t);
        ends[i] = sum;
    }
    *found = sum > 0.0;
    if (!*found) {
        return ALP_OK;
    }
    spread(emitters->triangles, ends, emitters->count, count, points);
    point_job job = {in, points, sum / count, surfels, count};
    return alpi_parallel_for(scene->context, count, 256, shine_all, &job, NULL);
}

alp_result alpi_trace_emitters(const alpi_map_scene *in, alpi_surfels *surfels, bool *found)
{
    alp_context *context = in->scene->context;
    alpi_emitters emitters = {0};
    *found = false;
    alp_result result = alpi_emitters_collect(in->scene, &emitters);
    if (result == ALP_OK && emitters.count > 0) {
        double *ends = ALPI_NEW(context, double, emitters.count);
        spread_point *points = ALPI_NEW(context, spread_point, surfels->count / 2);
        result = ends == NULL || points == NULL
                     ? ALP_ERROR_OUT_OF_MEMORY
                     : trace_list(in, &emitters, ends, points, surfels, found);
        alpi_release(context, ends);
        alpi_release(context, points);
    }
    alpi_emitters_clear(context, &emitters);
    return result;
}
