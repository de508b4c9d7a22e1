// SPDX-License-Identifier: MIT
#include "transport/paths/panes.h"

#include "base/random.h"
#include "transport/paths/hit.h"

static float mean_of(vec3 v)
{
    return (v.x + v.y + v.z) * (1.0f / 3.0f);
}

static bool is_pane(const alp_scene *scene, uint32_t triangle)
{
    return triangle != ALPI_NONE && alpi_surface_is_pane(scene, scene->triangle_surface[triangle]);
}

static vec3 multiply(vec3 a, vec3 b)
{
    return (vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}

/// Where a ray goes on behind what it hit.
static vec3 behind(const alp_scene *scene, const alpi_hits *hits, int lane, vec3 direction)
{
    const alpi_receiver_point p = alpi_hit_point(scene, hits, lane, direction, NULL);
    return vec3_mad(p.position, -p.offset, p.geometric_normal);
}

uint32_t alpi_panes_go_on(const alp_scene *scene, const alpi_hits *hits, uint32_t active,
                          alpi_rays *rays, vec3 left[ALPI_PACKET])
{
    uint32_t on = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((active >> i & 1u) == 0 || !is_pane(scene, hits->triangle[i])) {
            continue;
        }
        const alpi_pane pane =
            alpi_surface_pane(scene, hits->triangle[i], hits->b1[i], hits->b2[i]);
        const vec3 direction = {rays->direction_x[i], rays->direction_y[i], rays->direction_z[i]};
        const float rest = rays->maximum[i] - hits->distance[i];
        left[i] = multiply(left[i], pane.through);
        alpi_rays_set(rays, i, behind(scene, hits, i, direction), direction, rest);
        on |= rest > 0.0f && mean_of(left[i]) > 0.0f ? 1u << i : 0u;
    }
    return on;
}

void alpi_panes_dim(const alp_scene *scene, const alpi_tracer *tracer, alpi_trace_filter filter,
                    uint32_t active, alpi_rays *rays, vec3 left[ALPI_PACKET])
{
    alpi_hits hits;
    for (int i = 0; i < ALPI_PACKET; i++) {
        left[i] = (vec3){1.0f, 1.0f, 1.0f};
    }
    for (int passed = 0; active != 0 && passed < ALPI_PANE_LIMIT; passed++) {
        alpi_trace_nearest(tracer, rays, active, filter, &hits);
        active = alpi_panes_go_on(scene, &hits, active, rays, left);
    }
}

static float draw_pane(const alpi_path_wave *w, uint32_t i)
{
    const uint32_t number = w->event[i] * ALPI_USE_COUNT + ALPI_USE_PANE;
    return alpi_sample_2d(alpi_hash32(w->key[i] ^ alpi_hash32(number + 1u)), w->sample[i]).x;
}

/// Sends path i on behind the pane it hit.
static void trace_behind(const alpi_reference *r, alpi_path_wave *w, uint32_t i, alpi_hits *hits,
                         int lane)
{
    const vec3 direction = {w->direction.x[i], w->direction.y[i], w->direction.z[i]};
    alpi_rays rays;
    alpi_rays_clear(&rays);
    alpi_rays_set(&rays, lane, behind(r->scene, hits, lane, direction), direction, INFINITY);
    alpi_trace_nearest(r->tracer, &rays, 1u << lane, r->filter, hits);
}

float alpi_panes_pass(const alpi_reference *r, alpi_path_wave *w, uint32_t i, alpi_pane_met_fn *met,
                      float *distance)
{
    alpi_hits *hits = &w->hits[i / ALPI_PACKET];
    const int lane = (int)(i % ALPI_PACKET);
    *distance = hits->distance[lane];
    for (int passed = 0; passed < ALPI_PANE_LIMIT; passed++) {
        const uint32_t triangle = hits->triangle[lane];
        if (!is_pane(r->scene, triangle)) {
            return 1.0f;
        }
        const float b1 = hits->b1[lane], b2 = hits->b2[lane];
        const alpi_pane pane = alpi_surface_pane(r->scene, triangle, b1, b2);
        const float on = mean_of(pane.through);
        const float back = pane.kept * mean_of(alpi_surface_albedo(r->scene, triangle, b1, b2));
        const float chance = on + back > 0.0f ? on / (on + back) : 0.0f;
        w->event[i]++;
        if (!(draw_pane(w, i) < chance)) {
            return chance < 1.0f ? pane.kept / (1.0f - chance) : 0.0f;
        }
        met(r, w, i, triangle, b1, b2, *distance);
        w->throughput.x[i] *= pane.through.x / chance;
        w->throughput.y[i] *= pane.through.y / chance;
        w->throughput.z[i] *= pane.through.z / chance;
        trace_behind(r, w, i, hits, lane);
        *distance += hits->distance[lane];
    }
    return 0.0f;
}
