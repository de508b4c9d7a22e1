// SPDX-License-Identifier: MIT
#include "maps/texels/inside.h"

#include <math.h>

/// What is looked at.
typedef struct solids {
    const alpi_tracer *tracer;
    const alp_scene *scene;
} solids;

vec3 alpi_look_start(const alpi_receiver_point *p, float side)
{
    return vec3_mad(p->position, p->offset + 0.02f * side, p->geometric_normal);
}

void alpi_look_aim(const alpi_receiver_point *p, float side, alpi_look_kind kind, float length,
                   int lane, alpi_rays *rays)
{
    vec3 t, b, n = p->geometric_normal;
    vec3_frame(n, &t, &b);
    const vec3 axes[4] = {t, b, vec3_scale(t, -1.0f), vec3_scale(b, -1.0f)};
    const vec3 origin = alpi_look_start(p, side);
    for (int i = 0; i < 4; i++) {
        vec3 direction = axes[i];
        if (kind != ALPI_LOOK_ALONG) {
            const vec3 diagonal = vec3_add(axes[i], axes[(i + 1) % 4]);
            const float rise = kind == ALPI_LOOK_UP ? 1.0f : 0.0f;
            direction = vec3_normalize_or(vec3_mad(diagonal, rise, n), n);
        }
        alpi_rays_set(rays, lane + i, origin, direction, length);
    }
}

/// Whether a triangle is of glass, or of another thing that one sees into: it ends no solid.
static bool is_pane(const alp_scene *scene, uint32_t triangle)
{
    return alpi_surface_is_pane(scene, scene->triangle_surface[triangle]);
}

/// Whether a lane met the inside of a single-sided surface.
static bool met_back_face(const alp_scene *scene, const alpi_rays *rays, const alpi_hits *hits,
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

/// Sends four lanes of a look around on to the end of the scene, and as many rays back along them,
/// and counts the fronts that each meets: those on the way back are the backs on the way out,
/// which are told apart so even where two surfaces lie in one place. Panes are passed uncounted.
/// @return false: too many to tell
static bool count_crossings(const solids *s, const alpi_rays *look, int lane,
                            int fronts[ALPI_PACKET])
{
    enum { CROSSINGS = 32 };
    const alp_scene *scene = s->scene;
    const float length = 2.0f * vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    const float step = 0.5e-5f * length; // past what was met, by more than rounding
    alpi_rays rays;
    alpi_hits hits;
    alpi_rays_clear(&rays);
    for (int i = 0; i < 4; i++) {
        const int k = lane + i;
        const vec3 from = {look->origin_x[k], look->origin_y[k], look->origin_z[k]};
        const vec3 way = {look->direction_x[k], look->direction_y[k], look->direction_z[k]};
        alpi_rays_set(&rays, i, from, way, length);
        alpi_rays_set(&rays, i + 4, vec3_mad(from, length, way), vec3_scale(way, -1.0f), length);
    }
    uint32_t active = 0xffu;
    for (int crossing = 0; active != 0 && crossing < CROSSINGS; crossing++) {
        alpi_trace_nearest(s->tracer, &rays, active, (alpi_trace_filter){.one_sided = true}, &hits);
        for (int i = 0; i < ALPI_PACKET; i++) {
            const bool met = (active >> i & 1u) != 0 && hits.triangle[i] != ALPI_NONE;
            fronts[i] += met && !is_pane(scene, hits.triangle[i]);
            rays.minimum[i] = met ? hits.distance[i] + step : length;
            active &= met && rays.minimum[i] < length ? UINT32_MAX : ~(1u << i);
        }
    }
    return active == 0;
}

/// Whether four lanes of a look around began inside solids: along each of its lines, backs met less
/// fronts met are then as many as there are solids around it. Open surfaces give other numbers from
/// line to line. One of four may differ: where three surfaces lie in one place, one is not counted.
static bool is_enclosed(const solids *s, const alpi_rays *look, int lane)
{
    int fronts[ALPI_PACKET] = {0}, alike[4] = {0};
    const bool counted = count_crossings(s, look, lane, fronts);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 4; k++) {
            const int deep = fronts[i + 4] - fronts[i];
            alike[i] += deep > 0 && fronts[k + 4] - fronts[k] == deep;
        }
    }
    const int most = alike[0] > alike[1] ? alike[0] : alike[1]; // three alike are one of these
    return counted && most >= 3;
}

/// Whether what the four lanes of a look met tells something.
typedef bool met_fn(const solids *s, const alpi_rays *rays, const alpi_hits *hits, int lane,
                    float side);

/// Looks around the points that are asked, two in a packet. @return bits of those it is so of
static uint32_t look_around(const solids *s, const alpi_receiver_point *points, const float *sides,
                            uint32_t asked, alpi_look_kind kind, met_fn *met)
{
    uint32_t found = 0;
    while (asked != 0) {
        alpi_rays rays;
        alpi_hits hits;
        uint32_t pair[2], count = 0;
        alpi_rays_clear(&rays);
        for (; count < 2 && asked != 0; count++, asked &= asked - 1) {
            const uint32_t k = pair[count] = (uint32_t)__builtin_ctz(asked);
            alpi_look_aim(&points[k], sides[k], kind, kind == ALPI_LOOK_UP ? INFINITY : sides[k],
                          4 * (int)count, &rays);
        }
        alpi_trace_nearest(s->tracer, &rays, (1u << 4 * count) - 1u, (alpi_trace_filter){0}, &hits);
        for (uint32_t i = 0; i < count; i++) {
            const bool so = met(s, &rays, &hits, 4 * (int)i, sides[pair[i]]);
            found |= (so ? 1u : 0u) << pair[i];
        }
    }
    return found;
}

static int count_back_faces(const solids *s, const alpi_rays *rays, const alpi_hits *hits, int lane)
{
    int count = 0;
    for (int k = lane; k < lane + 4; k++) {
        count += met_back_face(s->scene, rays, hits, k);
    }
    return count;
}

static bool met_any_back(const solids *s, const alpi_rays *rays, const alpi_hits *hits, int lane,
                         float side)
{
    (void)side;
    return count_back_faces(s, rays, hits, lane) > 0;
}

/// Where something is near in all four directions, surfaces are counted.
static bool met_backs_above(const solids *s, const alpi_rays *rays, const alpi_hits *hits, int lane,
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

/// What is near is asked first: most that are inside are told so by short rays.
uint32_t alpi_are_inside(const alpi_tracer *tracer, const alp_scene *scene,
                         const alpi_receiver_point *points, const float *sides, uint32_t asked)
{
    const solids s = {tracer, scene};
    const uint32_t beside = look_around(&s, points, sides, asked, ALPI_LOOK_ALONG, met_any_back);
    return beside | look_around(&s, points, sides, asked & ~beside, ALPI_LOOK_UP, met_backs_above);
}
