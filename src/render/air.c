// SPDX-License-Identifier: MIT
// Single scattering of the volume's light and of lamps, by steps along each ray.
// Based on: A. Kaplanyan, C. Dachsbacher. Cascaded Light Propagation Volumes for Real-Time Indirect
//           Illumination. I3D 2010 (section 4.3).
#include "render/air.h"

#include "base/random.h"
#include "transport/paths/panes.h"

#include <math.h>

/// Steps along a ray, and panes whose tint of the medium is held.
enum { STEPS = 4 * ALPI_PACKET, PANES = 8 };

/// Part of a ray.
typedef struct span {
    float begin, end; // metres
} span;

/// The way of a ray: panes that tint all light from behind them, and the first surface that is
/// none.
typedef struct way {
    uint32_t panes;
    float at[PANES];     // metres, near to far; light of more panes is tinted as behind the last
    vec3 through[PANES]; // of that pane and those before it
    float end;           // metres, or INFINITY
} way;

static vec3 origin_of(const alpi_rays *rays, int lane)
{
    return (vec3){rays->origin_x[lane], rays->origin_y[lane], rays->origin_z[lane]};
}

static vec3 direction_of(const alpi_rays *rays, int lane)
{
    return (vec3){rays->direction_x[lane], rays->direction_y[lane], rays->direction_z[lane]};
}

static void follow_rays(const alpi_air *air, const alpi_rays *from, uint32_t lanes,
                        way ways[ALPI_PACKET])
{
    const alpi_field_light *l = air->light;
    alpi_trace_filter filter = l->filter;
    alpi_rays rays = *from;
    vec3 left[ALPI_PACKET];
    filter.panes = alpi_tracer_has_panes(l->tracer);
    for (int i = 0; i < ALPI_PACKET; i++) {
        left[i] = (vec3){1.0f, 1.0f, 1.0f};
        ways[i] = (way){.end = INFINITY};
    }
    for (int passed = 0; lanes != 0 && passed < ALPI_PANE_LIMIT; passed++) {
        alpi_hits hits;
        alpi_trace_nearest_coherent(l->tracer, &rays, lanes, filter, &hits);
        for (int i = 0; i < ALPI_PACKET; i++) {
            if ((lanes >> i & 1u) != 0) { // panes move origins
                const vec3 moved = vec3_sub(origin_of(&rays, i), origin_of(from, i));
                ways[i].end = hits.distance[i] + vec3_length(moved);
            }
        }
        lanes = filter.panes ? alpi_panes_go_on(l->scene, &hits, lanes, &rays, left) : 0;
        for (int i = 0; i < ALPI_PACKET; i++) {
            way *w = &ways[i];
            if ((lanes >> i & 1u) != 0 && w->panes < PANES) {
                w->at[w->panes] = w->end;
                w->through[w->panes++] = left[i];
            }
        }
    }
}

/// What is left of light that comes from a distance along the way.
static vec3 find_tint(const way *w, float distance)
{
    vec3 tint = {1.0f, 1.0f, 1.0f};
    for (uint32_t i = 0; i < w->panes && w->at[i] < distance; i++) {
        tint = w->through[i];
    }
    return tint;
}

/// The part of a ray inside the bounds of the scene, before its end.
static span clip(const alp_scene *scene, vec3 origin, vec3 direction, float end)
{
    const float o[3] = {origin.x, origin.y, origin.z};
    const float d[3] = {direction.x, direction.y, direction.z};
    float low[3], high[3];
    span s = {0.0f, end};
    vec3_store(low, scene->bounds_min);
    vec3_store(high, scene->bounds_max);
    for (int k = 0; k < 3; k++) {
        if (d[k] == 0.0f) {
            s.end = o[k] < low[k] || o[k] > high[k] ? 0.0f : s.end;
        } else {
            const float a = (low[k] - o[k]) / d[k], b = (high[k] - o[k]) / d[k];
            s.begin = fmaxf(s.begin, fminf(a, b));
            s.end = fminf(s.end, fmaxf(a, b));
        }
    }
    return s;
}

/// Share of the light that the medium scatters out of a span: 1 − e^(−S length).
static float find_scattered(const alpi_air *air, span s)
{
    return -expm1f(-air->scattering * fmaxf(s.end - s.begin, 0.0f));
}

/// Distance into the medium up to which the share u of the light of a span is scattered: steps of
/// equal shares are dense where the camera sees much of them.
static float find_depth(float scattering, float scattered, float u)
{
    return -log1pf(-u * scattered) / scattering;
}

/// Mean fluence / 4π of the steps of a span, as panes before them let it through.
/// @param scattered 1 − e^(−S length)   @param jitter [0, 1)
static vec3 average(const alpi_air *air, vec3 origin, vec3 direction, float begin, float scattered,
                    float jitter, const way *w)
{
    const float share = (float)(1.0 / (4.0 * ALPI_PI * STEPS));
    vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int step = 0; step < STEPS; step += ALPI_PACKET) {
        alpi_field_points points = {.count = ALPI_PACKET, .in_air = true};
        float fluence[ALPI_PACKET][3], distances[ALPI_PACKET];
        for (int i = 0; i < ALPI_PACKET; i++) {
            const float u = ((float)(step + i) + jitter) / STEPS;
            distances[i] = begin + find_depth(air->scattering, scattered, u);
            vec3_store(points.positions[i], vec3_mad(origin, distances[i], direction));
        }
        alp_lpv_fluence(air->lpv, ALPI_PACKET, (const float(*)[3])points.positions, fluence);
        alpi_field_light_add_lamps(air->light, &points, fluence);
        for (int i = 0; i < ALPI_PACKET; i++) {
            const vec3 tint = find_tint(w, distances[i]);
            sum.x += share * tint.x * fluence[i][0];
            sum.y += share * tint.y * fluence[i][1];
            sum.z += share * tint.z * fluence[i][2];
        }
    }
    return sum;
}

void alpi_air_along(const alpi_air *air, const alpi_rays *rays, uint32_t lanes, uint32_t key,
                    uint32_t first, vec3 scattered[ALPI_PACKET])
{
    const uint32_t air_key = alpi_hash32(key ^ 0x61697220u); // apart from places in the pixel
    way ways[ALPI_PACKET];
    follow_rays(air, rays, lanes, ways);
    for (int i = 0; i < ALPI_PACKET; i++) {
        scattered[i] = (vec3){0.0f, 0.0f, 0.0f};
        if ((lanes >> i & 1u) == 0) {
            continue;
        }
        const vec3 origin = origin_of(rays, i), direction = direction_of(rays, i);
        const span s = clip(air->light->scene, origin, direction, ways[i].end);
        const float share = find_scattered(air, s);
        const float jitter = alpi_sample_2d(air_key, first + (uint32_t)i).x;
        if (share > 0.0f) {
            const vec3 mean = average(air, origin, direction, s.begin, share, jitter, &ways[i]);
            scattered[i] = vec3_scale(mean, share);
        }
    }
}

static void dim(const void *user, const alpi_rays *rays, const alpi_hits *hits, uint32_t active,
                vec3 left[ALPI_PACKET])
{
    const alpi_air *air = user;
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((active >> i & 1u) != 0) {
            const span s = clip(air->light->scene, origin_of(rays, i), direction_of(rays, i),
                                hits->distance[i]);
            left[i] = vec3_scale(left[i], 1.0f - find_scattered(air, s));
        }
    }
}

alpi_medium alpi_air_medium(const alpi_air *air)
{
    return (alpi_medium){.dim = dim, .user = air};
}
