// SPDX-License-Identifier: MIT
// Single scattering of the volume's light and of lamps, by steps along each ray.
// Based on: A. Kaplanyan, C. Dachsbacher. Cascaded Light Propagation Volumes for Real-Time Indirect
//           Illumination. I3D 2010 (section 4.3).
#include "render/air.h"

#include "base/random.h"
#include "transport/paths/panes.h"

#include <math.h>

/// Steps along a ray.
enum { STEPS = 4 * ALPI_PACKET };

/// Part of a ray.
typedef struct span {
    float begin, end; // metres
} span;

/// Distances at which rays end: at the first surface that is no pane, or INFINITY.
static void find_ends(const alpi_air *air, const alpi_rays *from, uint32_t lanes,
                      float ends[ALPI_PACKET])
{
    const alpi_field_light *l = air->light;
    alpi_trace_filter filter = l->filter;
    alpi_rays rays = *from;
    vec3 left[ALPI_PACKET];
    filter.panes = alpi_tracer_has_panes(l->tracer);
    for (int i = 0; i < ALPI_PACKET; i++) {
        left[i] = (vec3){1.0f, 1.0f, 1.0f};
        ends[i] = INFINITY;
    }
    for (int passed = 0; lanes != 0 && passed < ALPI_PANE_LIMIT; passed++) {
        alpi_hits hits;
        alpi_trace_nearest_coherent(l->tracer, &rays, lanes, filter, &hits);
        for (int i = 0; i < ALPI_PACKET; i++) {
            if ((lanes >> i & 1u) != 0) { // panes move origins
                const vec3 moved = {rays.origin_x[i] - from->origin_x[i],
                                    rays.origin_y[i] - from->origin_y[i],
                                    rays.origin_z[i] - from->origin_z[i]};
                ends[i] = hits.distance[i] + vec3_length(moved);
            }
        }
        lanes = filter.panes ? alpi_panes_go_on(l->scene, &hits, lanes, &rays, left) : 0;
    }
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

/// Distance into the medium up to which the share u of the light of a span is scattered: steps of
/// equal shares are dense where the camera sees much of them.
static float find_depth(float scattering, float scattered, float u)
{
    return -log1pf(-u * scattered) / scattering;
}

/// Mean fluence / 4π of the steps of a span. @param scattered 1 − e^(−S length)   @param jitter [0,
/// 1)
static vec3 average(const alpi_air *air, vec3 origin, vec3 direction, float begin, float scattered,
                    float jitter)
{
    const float share = (float)(1.0 / (4.0 * ALPI_PI * STEPS));
    vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int step = 0; step < STEPS; step += ALPI_PACKET) {
        alpi_field_points points = {.count = ALPI_PACKET, .in_air = true};
        float fluence[ALPI_PACKET][3];
        for (int i = 0; i < ALPI_PACKET; i++) {
            const float u = ((float)(step + i) + jitter) / STEPS;
            const float t = begin + find_depth(air->scattering, scattered, u);
            vec3_store(points.positions[i], vec3_mad(origin, t, direction));
        }
        alp_lpv_fluence(air->lpv, ALPI_PACKET, (const float(*)[3])points.positions, fluence);
        alpi_field_light_add_lamps(air->light, &points, fluence);
        for (int i = 0; i < ALPI_PACKET; i++) {
            sum = vec3_mad(sum, share, vec3_load(fluence[i]));
        }
    }
    return sum;
}

void alpi_air_along(const alpi_air *air, const alpi_rays *rays, uint32_t lanes, uint32_t key,
                    uint32_t first, vec3 scattered[ALPI_PACKET], float left[ALPI_PACKET])
{
    const uint32_t air_key = alpi_hash32(key ^ 0x61697220u); // apart from places in the pixel
    float ends[ALPI_PACKET];
    find_ends(air, rays, lanes, ends);
    for (int i = 0; i < ALPI_PACKET; i++) {
        const vec3 origin = {rays->origin_x[i], rays->origin_y[i], rays->origin_z[i]};
        const vec3 direction = {rays->direction_x[i], rays->direction_y[i], rays->direction_z[i]};
        scattered[i] = (vec3){0.0f, 0.0f, 0.0f};
        left[i] = 1.0f;
        if ((lanes >> i & 1u) == 0) {
            continue;
        }
        const span s = clip(air->light->scene, origin, direction, ends[i]);
        const float share = -expm1f(-air->scattering * fmaxf(s.end - s.begin, 0.0f));
        const float jitter = alpi_sample_2d(air_key, first + (uint32_t)i).x;
        if (share > 0.0f) {
            const vec3 mean = average(air, origin, direction, s.begin, share, jitter);
            scattered[i] = vec3_scale(mean, share);
            left[i] = 1.0f - share;
        }
    }
}
