// SPDX-License-Identifier: MIT
// Rays by testing every triangle, in double precision: slow, plain, and the oracle of the fast way.
// Based on: Möller, Trumbore. Fast, Minimum Storage Ray/Triangle Intersection. JGT 2(1), 1997.
#include "trace/trace.h"

#include "scene/sides.h"

typedef struct vec3d {
    double x, y, z;
} vec3d;

static vec3d load(const float *p)
{
    return (vec3d){(double)p[0], (double)p[1], (double)p[2]};
}

static vec3d subtract(vec3d a, vec3d b)
{
    return (vec3d){a.x - b.x, a.y - b.y, a.z - b.z};
}

static vec3d cross(vec3d a, vec3d b)
{
    return (vec3d){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(vec3d a, vec3d b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

typedef struct hit {
    double distance, b1, b2;
    bool from_behind;
} hit;

/// Solves origin + distance·direction = a + b1·(b − a) + b2·(c − a).
static bool intersect(const alp_scene *scene, uint32_t triangle, vec3d origin, vec3d direction,
                      hit *h)
{
    const uint32_t *v = scene->triangles[triangle];
    vec3d a = load(scene->positions[v[0]]);
    vec3d e1 = subtract(load(scene->positions[v[1]]), a);
    vec3d e2 = subtract(load(scene->positions[v[2]]), a);
    vec3d p = cross(direction, e2);
    double determinant = dot(e1, p);
    if (determinant == 0.0) {
        return false; // parallel to the plane
    }
    vec3d s = subtract(origin, a);
    vec3d q = cross(s, e1);
    h->b1 = dot(s, p) / determinant;
    h->b2 = dot(direction, q) / determinant;
    h->distance = dot(e2, q) / determinant;
    h->from_behind = determinant < 0.0; // the direction runs along the outer normal
    return h->b1 >= 0.0 && h->b2 >= 0.0 && h->b1 + h->b2 <= 1.0;
}

static bool passes(const alp_scene *scene, uint32_t triangle, const hit *h,
                   alpi_trace_filter filter)
{
    uint32_t material = scene->surfaces[scene->triangle_surface[triangle]].material;
    bool double_sided = material != ALPI_NONE && scene->materials[material].double_sided;
    const bool met = filter.panes && alpi_surface_is_pane(scene, scene->triangle_surface[triangle]);
    return (filter.one_sided && h->from_behind && !double_sided) ||
           (!met && alpi_surface_is_cut(scene, triangle, (float)h->b1, (float)h->b2));
}

/// A ray in double precision, and how far it reaches.
typedef struct ray {
    vec3d origin, direction;
    double minimum, maximum;
} ray;

/// The nearest hit between minimum and maximum. @param fronts no back is met
/// @return its triangle, ALPI_NONE for none
static uint32_t find_nearest(const alp_scene *scene, const ray *r, alpi_trace_filter filter,
                             bool fronts, hit *nearest)
{
    uint32_t found = ALPI_NONE;
    nearest->distance = r->maximum;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        hit h;
        if (scene->triangle_usable[t] && intersect(scene, t, r->origin, r->direction, &h) &&
            h.distance >= r->minimum && h.distance <= nearest->distance &&
            !(fronts && h.from_behind != alpi_sides_is_turned(scene, t)) &&
            !passes(scene, t, &h, filter)) {
            *nearest = h;
            found = t;
        }
    }
    return found;
}

/// A front in the place of a back (alpi_trace_place).
static uint32_t find_front(const alp_scene *scene, const ray *r, alpi_trace_filter filter,
                           uint32_t back, hit *nearest)
{
    vec3 c[3];
    const vec3 origin = {(float)r->origin.x, (float)r->origin.y, (float)r->origin.z};
    const vec3 way = {(float)r->direction.x, (float)r->direction.y, (float)r->direction.z};
    alpi_triangle_corners(scene, back, c);
    const vec3 normal = vec3_cross(vec3_sub(c[1], c[0]), vec3_sub(c[2], c[0]));
    const double near = (double)alpi_trace_place(origin, way, normal, (float)nearest->distance);
    ray around = *r;
    around.minimum = fmax(r->minimum, nearest->distance - near);
    around.maximum = fmin(r->maximum, nearest->distance + near);
    hit front;
    const uint32_t found = find_nearest(scene, &around, filter, true, &front);
    *nearest = found != ALPI_NONE ? front : *nearest;
    return found != ALPI_NONE ? found : back;
}

void alpi_brute_force_nearest(const alp_scene *scene, const alpi_rays *rays, uint32_t active,
                              alpi_trace_filter filter, alpi_hits *hits)
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((active >> i & 1u) == 0) {
            continue;
        }
        const ray r = {
            {(double)rays->origin_x[i], (double)rays->origin_y[i], (double)rays->origin_z[i]},
            {(double)rays->direction_x[i], (double)rays->direction_y[i],
             (double)rays->direction_z[i]},
            (double)rays->minimum[i],
            (double)rays->maximum[i]};
        hit h;
        uint32_t triangle = find_nearest(scene, &r, filter, false, &h);
        if (triangle != ALPI_NONE && !filter.backs &&
            h.from_behind != alpi_sides_is_turned(scene, triangle)) {
            triangle = find_front(scene, &r, filter, triangle, &h);
        }
        const bool met = triangle != ALPI_NONE;
        hits->triangle[i] = triangle;
        hits->distance[i] = met ? (float)h.distance : INFINITY;
        hits->b1[i] = met ? (float)h.b1 : 0.0f;
        hits->b2[i] = met ? (float)h.b2 : 0.0f;
        const bool behind = met && h.from_behind != alpi_sides_is_turned(scene, triangle);
        hits->behind = (hits->behind & ~(1u << i)) | (behind ? 1u << i : 0u);
    }
}
