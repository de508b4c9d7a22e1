// SPDX-License-Identifier: MIT
#include "transport/panes.h"

#include "base/random.h"
#include "transport/hit.h"

// More panes in a row than any scene has; a ray that is held up by rounding ends here.
enum { PANE_LIMIT = 4096 };

static float mean_of(vec3 v)
{
    return (v.x + v.y + v.z) * (1.0f / 3.0f);
}

static bool is_pane(const alpi_reference *r, uint32_t triangle)
{
    return triangle != ALPI_NONE &&
           alpi_surface_is_pane(r->scene, r->scene->triangle_surface[triangle]);
}

static vec3 multiply(vec3 a, vec3 b)
{
    return (vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}

/// Where a ray goes on behind what it hit.
static vec3 behind(const alpi_reference *r, const alpi_hits *hits, int lane, vec3 direction)
{
    const alpi_receiver_point p = alpi_hit_point(r->scene, hits, lane, direction, NULL);
    return vec3_mad(p.position, -p.offset, p.geometric_normal);
}

void alpi_panes_dim(const alpi_reference *r, alpi_rays *rays, uint32_t active,
                    vec3 left[ALPI_PACKET])
{
    alpi_hits hits;
    for (int i = 0; i < ALPI_PACKET; i++) {
        left[i] = (vec3){1.0f, 1.0f, 1.0f};
    }
    for (int passed = 0; active != 0 && passed < PANE_LIMIT; passed++) {
        alpi_trace_nearest(r->tracer, rays, active, r->filter, &hits);
        for (int i = 0; i < ALPI_PACKET; i++) {
            if ((active >> i & 1u) == 0 || !is_pane(r, hits.triangle[i])) {
                active &= ~(1u << i);
                continue;
            }
            left[i] = multiply(left[i], alpi_surface_pane(r->scene, hits.triangle[i], hits.b1[i],
                                                          hits.b2[i])
                                            .through);
            const vec3 direction = {rays->direction_x[i], rays->direction_y[i],
                                    rays->direction_z[i]};
            const float rest = rays->maximum[i] - hits.distance[i];
            alpi_rays_set(rays, i, behind(r, &hits, i, direction), direction, rest);
            if (!(rest > 0.0f) || !(mean_of(left[i]) > 0.0f)) {
                active &= ~(1u << i);
            }
        }
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
    alpi_rays_set(&rays, lane, behind(r, hits, lane, direction), direction, INFINITY);
    alpi_trace_nearest(r->tracer, &rays, 1u << lane, r->filter, hits);
}

float alpi_panes_pass(const alpi_reference *r, alpi_path_wave *w, uint32_t i,
                      alpi_pane_met_fn *met, float *distance)
{
    alpi_hits *hits = &w->hits[i / ALPI_PACKET];
    const int lane = (int)(i % ALPI_PACKET);
    *distance = hits->distance[lane];
    for (int passed = 0; passed < PANE_LIMIT; passed++) {
        const uint32_t triangle = hits->triangle[lane];
        if (!is_pane(r, triangle)) {
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
