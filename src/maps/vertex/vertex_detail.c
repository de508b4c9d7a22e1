// SPDX-License-Identifier: MIT
// A few points by rays, all over the surface: what the interpolant between vertices misses.
#include "maps/vertex/vertex_detail.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"

#include <math.h>

enum { RAYS_PER_HALF = 32, POINTS_LEAST = 1024, POINTS_MOST = 65536, TICK_POINTS = 4096 };
enum { STREAM_PLACE = 11 }; // random numbers of points, apart from those of rays

/// Points on the surface and what was found there.
typedef struct measuring {
    const alpi_vertex_map *map;
    const float *values;
    alpi_point_array points;
    uint32_t *triangles;      // [points.count]
    float (*barycentrics)[2]; // [points.count]
    float *halves[2];         // [points.count] independent estimates of accessibility
} measuring;

static void place_point(measuring *m, uint32_t i, uint32_t triangle, float b1, float b2)
{
    alpi_receiver_point at = alpi_vertex_map_point(m->map->scene, triangle, (double)b1, (double)b2);
    m->triangles[i] = triangle;
    m->barycentrics[i][0] = b1;
    m->barycentrics[i][1] = b2;
    vec3_store(m->points.positions[i], at.position);
    vec3_store(m->points.geometric_normals[i], at.geometric_normal);
    vec3_store(m->points.shading_normals[i], at.shading_normal);
    m->points.offsets[i] = at.offset;
}

/// Point i lies in the i-th of `count` equal parts of the area, the triangles laid end to end.
static alp_result place_points(measuring *m, uint64_t seed)
{
    const alp_scene *scene = m->map->scene;
    uint32_t t = 0, last = ALPI_NONE; // the last usable triangle before t
    double before = 0.0;              // area of the triangles before t
    for (uint32_t i = 0; i < m->points.count; i++) {
        uint32_t key = alpi_random_key(seed, i, STREAM_PLACE);
        vec2 u = alpi_sample_2d(key, 0), w = alpi_sample_2d(key, 1);
        double place = ((double)i + (double)u.x) / m->points.count * scene->area;
        for (; t < scene->triangle_count && (before <= place || last == ALPI_NONE); t++) {
            if (t % TICK_POINTS == 0) {
                ALP_TRY(alpi_tick(m->map->context, "detail", t, scene->triangle_count));
            }
            if (scene->triangle_usable[t]) {
                vec3 c[3];
                alpi_triangle_corners(scene, t, c);
                before += vec3_triangle_area(c[0], c[1], c[2]);
                last = t;
            }
        }
        float radius = sqrtf(u.y);
        place_point(m, i, last, radius * (1.0f - w.x), radius * w.x);
    }
    return ALP_OK;
}

/// What the interpolant shows at a point.
static double shown(const measuring *m, uint32_t i)
{
    const uint32_t *v = m->map->scene->triangles[m->triangles[i]];
    const uint32_t *receivers = m->map->vertex_receivers;
    double b1 = (double)m->barycentrics[i][0], b2 = (double)m->barycentrics[i][1];
    return (1.0 - b1 - b2) * (double)m->values[receivers[v[0]]] +
           b1 * (double)m->values[receivers[v[1]]] + b2 * (double)m->values[receivers[v[2]]];
}

static double longest_edge(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    double longest = 0.0;
    for (int k = 0; k < 3; k++) {
        longest = fmax(longest, (double)vec3_length(vec3_sub(c[(k + 1) % 3], c[k])));
    }
    return longest;
}

static void sum_up(const measuring *m, alpi_vertex_detail *details)
{
    const alp_scene *scene = m->map->scene;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        details[s] = (alpi_vertex_detail){0};
    }
    for (uint32_t i = 0; i < m->points.count; i++) {
        double first = (double)m->halves[0][i], second = (double)m->halves[1][i];
        if (first <= 0.0 && second <= 0.0) {
            continue; // buried: nobody sees it
        }
        double square = (shown(m, i) - first) * (shown(m, i) - second);
        alpi_vertex_detail *d = &details[scene->triangle_surface[m->triangles[i]]];
        d->point_count++;
        d->square += square;
        d->weight += fabs(square);
        d->edge += fabs(square) * longest_edge(scene, m->triangles[i]);
    }
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        alpi_vertex_detail *d = &details[s];
        d->edge = d->weight > 0.0 ? d->edge / d->weight : 0.0;
        d->square = d->point_count > 0 ? d->square / d->point_count : 0.0;
    }
}

static alp_result measure(measuring *m, const alpi_tracer *tracer, alp_occlusion_options options)
{
    uint32_t count = m->points.count;
    ALPI_TRY_NEW(m->map->context, m->triangles, count);
    ALPI_TRY_NEW(m->map->context, m->barycentrics, count);
    ALP_TRY(place_points(m, options.seed));
    const alpi_receivers receivers = alpi_point_array_receivers(&m->points);
    options.samples = RAYS_PER_HALF;
    const uint64_t seed = alpi_hash64(options.seed); // neither the bake's nor each other's
    for (uint64_t half = 0; half < 2; half++) {
        ALPI_TRY_NEW(m->map->context, m->halves[half], count);
        options.seed = alpi_hash64(seed + half);
        alpi_occlusion_setup setup;
        ALP_TRY(alpi_occlusion_prepare(m->map->scene, tracer, &options, &setup));
        alp_result result = alpi_occlusion_gather(&setup, &receivers, NULL, count, m->halves[half]);
        alpi_occlusion_release(&setup);
        ALP_TRY(result);
    }
    return ALP_OK;
}

alp_result alpi_vertex_map_measure(const alpi_vertex_map *map, const alpi_tracer *tracer,
                                   const alp_occlusion_options *options, const float *values,
                                   alpi_vertex_detail *details, uint64_t *rays)
{
    measuring m = {.map = map, .values = values};
    double wanted = 0.1 * map->count * options->samples / (2.0 * RAYS_PER_HALF);
    uint32_t count = (uint32_t)fmin(fmax(wanted, POINTS_LEAST), POINTS_MOST);
    *rays = 2 * (uint64_t)RAYS_PER_HALF * count;
    ALP_TRY(alpi_point_array_create(map->context, count, &m.points));
    alp_result result = measure(&m, tracer, *options);
    if (result == ALP_OK) {
        sum_up(&m, details);
    }
    alpi_point_array_destroy(map->context, &m.points);
    alpi_release(map->context, m.triangles);
    alpi_release(map->context, m.barycentrics);
    alpi_release(map->context, m.halves[0]);
    alpi_release(map->context, m.halves[1]);
    return result;
}
