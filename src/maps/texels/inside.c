// SPDX-License-Identifier: MIT
#include "maps/texels/inside.h"

#include <math.h>

typedef struct solids {
    const alpi_tracer *tracer;
    const alp_scene *scene;
} solids;

vec3 alpi_ring_origin(const alpi_receiver_point *p, float side)
{
    return vec3_mad(p->position, p->offset + 0.02f * side, p->geometric_normal);
}

void alpi_ring_aim(const alpi_receiver_point *p, float side, alpi_ring_kind kind, float length,
                   int lane, alpi_rays *rays)
{
    vec3 t, b, n = p->geometric_normal;
    vec3_frame(n, &t, &b);
    const vec3 axes[4] = {t, b, vec3_scale(t, -1.0f), vec3_scale(b, -1.0f)};
    const vec3 origin = alpi_ring_origin(p, side);
    for (int i = 0; i < 4; i++) {
        vec3 direction = axes[i];
        if (kind != ALPI_RING_AXES) {
            const vec3 diagonal = vec3_add(axes[i], axes[(i + 1) % 4]);
            const float rise = kind == ALPI_RING_RAISED ? 1.0f : 0.0f;
            direction = vec3_normalize_or(vec3_mad(diagonal, rise, n), n);
        }
        alpi_rays_set(rays, lane + i, origin, direction, length);
    }
}

/// Whether a triangle is a pane, such as glass, which bounds no solid.
static bool is_pane(const alp_scene *scene, uint32_t triangle)
{
    return alpi_surface_is_pane(scene, scene->triangle_surface[triangle]);
}

/// Whether a lane hit the back of a single-sided surface.
static bool is_back_face(const alp_scene *scene, const alpi_rays *rays, const alpi_hits *hits,
                         int lane)
{
    const uint32_t triangle = hits->triangle[lane];
    if (triangle == ALPI_NONE || alpi_surface_is_double_sided(scene, triangle) ||
        is_pane(scene, triangle)) {
        return false;
    }
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    const vec3 none = {0.0f, 0.0f, 0.0f};
    const vec3 direction = {rays->direction_x[lane], rays->direction_y[lane],
                            rays->direction_z[lane]};
    return vec3_dot(vec3_triangle_normal(c[0], c[1], c[2], none), direction) > 0.0f;
}

/// Traces the lines of a ring to the end of the scene and back, and counts the fronts that each ray
/// hits. Fronts on the way back are backs on the way out, even if two surfaces coincide. Panes do
/// not count. @return false: too many crossings
static bool count_crossings(const solids *s, const alpi_rays *from, int lane,
                            int fronts[ALPI_PACKET])
{
    enum { CROSSINGS = 32 };
    const alp_scene *scene = s->scene;
    const float length = 2.0f * vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    const float step = 0.5e-5f * length; // past a hit, by more than rounding
    alpi_rays rays;
    alpi_hits hits;
    alpi_rays_clear(&rays);
    for (int i = 0; i < 4; i++) {
        const int k = lane + i;
        const vec3 origin = {from->origin_x[k], from->origin_y[k], from->origin_z[k]};
        const vec3 way = {from->direction_x[k], from->direction_y[k], from->direction_z[k]};
        alpi_rays_set(&rays, i, origin, way, length);
        alpi_rays_set(&rays, i + 4, vec3_mad(origin, length, way), vec3_scale(way, -1.0f), length);
    }
    uint32_t active = 0xffu;
    for (int crossing = 0; active != 0 && crossing < CROSSINGS; crossing++) {
        alpi_trace_nearest(s->tracer, &rays, active, (alpi_trace_filter){.one_sided = true}, &hits);
        for (int i = 0; i < ALPI_PACKET; i++) {
            const bool hit = (active >> i & 1u) != 0 && hits.triangle[i] != ALPI_NONE;
            fronts[i] += hit && !is_pane(scene, hits.triangle[i]);
            rays.minimum[i] = hit ? hits.distance[i] + step : length;
            active &= hit && rays.minimum[i] < length ? UINT32_MAX : ~(1u << i);
        }
    }
    return active == 0;
}

/// Whether a ring begins inside solids. Along each of its lines, backs minus fronts are then the
/// number of solids around it; open surfaces give different numbers. One line may differ, since one
/// of three surfaces in one place is not counted.
static bool is_enclosed(const solids *s, const alpi_rays *ring, int lane)
{
    int fronts[ALPI_PACKET] = {0}, alike[4] = {0};
    const bool counted = count_crossings(s, ring, lane, fronts);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 4; k++) {
            const int deep = fronts[i + 4] - fronts[i];
            alike[i] += deep > 0 && fronts[k + 4] - fronts[k] == deep;
        }
    }
    const int most = alike[0] > alike[1] ? alike[0] : alike[1]; // three alike are one of these
    return counted && most >= 3;
}

/// Whether the hits of a ring show that its point is inside.
typedef bool inside_fn(const solids *s, const alpi_rays *rays, const alpi_hits *hits, int lane,
                       float side);

/// Traces a ring around each tested point, two in a packet. @return bits of the points inside
static uint32_t trace_rings(const solids *s, const alpi_receiver_point *points, const float *sides,
                            uint32_t tested, alpi_ring_kind kind, inside_fn *is_inside)
{
    uint32_t found = 0;
    while (tested != 0) {
        alpi_rays rays;
        alpi_hits hits;
        uint32_t pair[2], count = 0;
        alpi_rays_clear(&rays);
        for (; count < 2 && tested != 0; count++, tested &= tested - 1) {
            const uint32_t k = pair[count] = (uint32_t)__builtin_ctz(tested);
            alpi_ring_aim(&points[k], sides[k], kind,
                          kind == ALPI_RING_RAISED ? INFINITY : sides[k], 4 * (int)count, &rays);
        }
        alpi_trace_nearest(s->tracer, &rays, (1u << 4 * count) - 1u, (alpi_trace_filter){0}, &hits);
        for (uint32_t i = 0; i < count; i++) {
            const bool inside = is_inside(s, &rays, &hits, 4 * (int)i, sides[pair[i]]);
            found |= (inside ? 1u : 0u) << pair[i];
        }
    }
    return found;
}

static int count_back_faces(const solids *s, const alpi_rays *rays, const alpi_hits *hits, int lane)
{
    int count = 0;
    for (int k = lane; k < lane + 4; k++) {
        count += is_back_face(s->scene, rays, hits, k);
    }
    return count;
}

static bool hits_any_back(const solids *s, const alpi_rays *rays, const alpi_hits *hits, int lane,
                          float side)
{
    (void)side;
    return count_back_faces(s, rays, hits, lane) > 0;
}

/// Counts surfaces if all four rays hit something near.
static bool is_covered(const solids *s, const alpi_rays *rays, const alpi_hits *hits, int lane,
                       float side)
{
    enum { CAVE = 4 }; // texels
    int closed = 0;
    for (int k = lane; k < lane + 4; k++) {
        closed += hits->triangle[k] != ALPI_NONE && hits->distance[k] < CAVE * side;
    }
    return count_back_faces(s, rays, hits, lane) >= 3 ||
           (closed == 4 && is_enclosed(s, rays, lane));
}

/// Short rays come first, since they find most points that are inside.
uint32_t alpi_are_inside(const alpi_tracer *tracer, const alp_scene *scene,
                         const alpi_receiver_point *points, const float *sides, uint32_t tested)
{
    const solids s = {tracer, scene};
    const uint32_t found = trace_rings(&s, points, sides, tested, ALPI_RING_AXES, hits_any_back);
    return found | trace_rings(&s, points, sides, tested & ~found, ALPI_RING_RAISED, is_covered);
}
