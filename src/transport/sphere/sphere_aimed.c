// SPDX-License-Identifier: MIT
#include "transport/sphere/sphere_aimed.h"

#include "base/random.h"
#include "base/warp.h"
#include "transport/paths/panes.h"

#include <math.h>

enum { USE_AXIS = 1, USE_PLACE, USE_CHOICE };

alpi_sphere_aim alpi_sphere_aim_for(const alpi_sphere_rays *rays, vec3 point, uint32_t key)
{
    const uint32_t random = alpi_hash32(key ^ alpi_hash32(USE_AXIS));
    const vec2 u = {alpi_unit_float(random), alpi_unit_float(alpi_hash32(random))};
    return (alpi_sphere_aim){rays, point, alpi_warp_uniform_cone(u, -1.0f), key,
                             alpi_sphere_pairs(rays)};
}

static vec3 hemisphere(const alpi_sphere_aim *aim, uint32_t sample)
{
    return sample % 2 == 0 ? aim->axis : vec3_scale(aim->axis, -1.0f);
}

/// Draws a sample, and the light that it brings if nothing is in between: radiance times solid
/// angle, over the samples of its side. @return false: nothing
static bool draw(const alpi_sphere_aim *aim, uint32_t sample, alpi_light_sample *s, vec3 *given)
{
    // Both sides draw alike. The sources are chosen in the order of the samples, so that those of
    // each source follow each other and spread over it evenly.
    const uint32_t own = sample / 2;
    const vec2 u = alpi_sample_2d(alpi_hash32(aim->key ^ alpi_hash32(USE_PLACE)), own);
    const uint32_t choice = alpi_hash32(aim->key ^ alpi_hash32(USE_CHOICE + own));
    const float pick = ((float)own + alpi_unit_float(choice)) / (float)aim->pairs;
    const vec3 normal = hemisphere(aim, sample);
    if (!alpi_lighting_sample(aim->rays->aimed, aim->point, normal, pick, u, s) ||
        !(vec3_dot(s->direction, normal) > 0.0f)) {
        return false;
    }
    const float factor = 1.0f / ((float)aim->pairs * s->density);
    *given = vec3_scale(s->light, factor);
    return isfinite(factor);
}

static void trace(const alpi_sphere_aim *aim, alpi_rays *rays, uint32_t active, vec3 *given)
{
    active = alpi_occluders_open(aim->rays->occluders, rays, rays->maximum, active);
    const alpi_gather_scene *from = &aim->rays->from;
    alpi_trace_filter filter = from->filter;
    filter.panes = alpi_tracer_has_panes(from->tracer);
    alpi_trace_occluded(from->tracer, rays, 1, active, filter, ALPI_RAYS_NEAR);
    uint32_t open = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        open |= (active >> i & 1u) != 0 && rays->maximum[i] >= 0.0f ? 1u << i : 0u;
    }
    if (filter.panes && open != 0) {
        vec3 left[ALPI_PACKET] = {{0.0f, 0.0f, 0.0f}};
        alpi_panes_dim(from->scene, from->tracer, filter, open, rays, left);
        for (int i = 0; i < ALPI_PACKET; i++) {
            given[i] =
                (vec3){given[i].x * left[i].x, given[i].y * left[i].y, given[i].z * left[i].z};
        }
    }
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((open >> i & 1u) == 0) {
            given[i] = (vec3){0.0f, 0.0f, 0.0f};
        }
    }
}

void alpi_sphere_aimed_light(const alpi_sphere_aim *aim, const alpi_sphere_loops *loops,
                             alpi_sphere_tallies *tallies)
{
    const float offset = alpi_receiver_offset(aim->point, NULL);
    for (uint32_t packet = 0; packet < 2 * aim->pairs / ALPI_PACKET; packet++) {
        alpi_sphere_packet p;
        vec3 given[ALPI_PACKET];
        uint32_t active = 0;
        alpi_rays_clear(&p.rays);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            alpi_light_sample s;
            given[i] = (vec3){0.0f, 0.0f, 0.0f};
            if (draw(aim, packet * ALPI_PACKET + i, &s, &given[i])) {
                const float reach = s.distance * (1.0f - 1e-5f) - 2.0f * offset;
                alpi_rays_set(&p.rays, (int)i, aim->point, s.direction, fmaxf(reach, 0.0f));
                active |= 1u << i;
            }
        }
        if (active == 0) {
            continue;
        }
        alpi_rays shadow = p.rays; // tracing destroys it
        trace(aim, &shadow, active, given);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            p.weight[i] = 1.0f;
            p.light[0][i] = given[i].x;
            p.light[1][i] = given[i].y;
            p.light[2][i] = given[i].z;
        }
        loops->add(&p, 1, tallies);
    }
}
