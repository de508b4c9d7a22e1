// SPDX-License-Identifier: MIT
// Light of probes in solids, from valid neighbours. A reader that interpolates without visibility
// then finds no black probe beside a surface.
#include "base/memory.h"
#include "fields/probes/probes.h"

#include <math.h>
#include <string.h>

enum { REACH = 2 }; // cells

/// Where a ray from one point first meets a surface on its way to another, metres.
static float first_surface(const alpi_probe_sampling *s, vec3 from, vec3 to)
{
    const vec3 way = vec3_sub(to, from);
    const float distance = vec3_length(way);
    const vec3 unit = vec3_scale(way, 1.0f / distance);
    alpi_rays rays;
    alpi_hits hits;
    alpi_rays_clear(&rays);
    alpi_rays_set(&rays, 0, from, unit, distance);
    alpi_trace_nearest(s->rays.from.tracer, &rays, 1u, s->rays.from.filter, &hits);
    return hits.distance[0];
}

/// Whether at most one surface parts a probe in a solid from a neighbour: the one that the solid
/// shows to it.
static bool sees(const alpi_probe_sampling *s, vec3 neighbour, vec3 probe)
{
    const float distance = vec3_length(vec3_sub(probe, neighbour));
    const float there = first_surface(s, neighbour, probe);
    if (there >= distance) {
        return true;
    }
    return there + first_surface(s, probe, neighbour) >= distance * 0.999f;
}

/// Adds the neighbours of a probe, weighed by inverse squares of their distances.
static double add_neighbours(const alpi_probe_sampling *s, const alpi_probe_volume *v,
                             uint32_t index, double *sums, uint32_t floats)
{
    const int at[3] = {(int)(index % v->size[0]), (int)(index / v->size[0] % v->size[1]),
                       (int)(index / v->size[0] / v->size[1])};
    const vec3 probe = vec3_load(s->points[index]);
    double weight = 0.0;
    for (int n = 0; n < (2 * REACH + 1) * (2 * REACH + 1) * (2 * REACH + 1); n++) {
        const int side = 2 * REACH + 1;
        const int to[3] = {at[0] + n % side - REACH, at[1] + n / side % side - REACH,
                           at[2] + n / side / side - REACH};
        bool there = true;
        for (int k = 0; k < 3; k++) {
            there = there && to[k] >= 0 && to[k] < (int)v->size[k];
        }
        if (!there) {
            continue;
        }
        const uint32_t other =
            (uint32_t)to[0] + v->size[0] * ((uint32_t)to[1] + v->size[1] * (uint32_t)to[2]);
        const vec3 from = vec3_load(s->points[other]);
        if (v->states[other] > ALPI_PROBE_MOVED || !sees(s, from, probe)) {
            continue;
        }
        const vec3 way = vec3_sub(from, probe);
        const double w = 1.0 / ((double)vec3_dot(way, way) + 1e-30);
        const float *c = v->coefficients + (size_t)other * floats;
        for (uint32_t i = 0; i < floats; i++) {
            sums[i] += w * (double)c[i];
        }
        weight += w;
    }
    return weight;
}

alp_result alpi_probes_fill(const alpi_probe_sampling *s, alpi_probe_volume *v)
{
    const uint32_t floats = 3 * v->coefficient_count;
    for (uint32_t i = 0; i < v->count && !v->is_list; i++) {
        double sums[3 * ALPI_SH9_COUNT] = {0.0};
        if (v->states[i] != ALPI_PROBE_INVALID) {
            continue;
        }
        const double weight = add_neighbours(s, v, i, sums, floats);
        for (uint32_t k = 0; k < floats && weight > 0.0; k++) {
            v->coefficients[(size_t)i * floats + k] = (float)(sums[k] / weight);
        }
        v->states[i] = weight > 0.0 ? ALPI_PROBE_FILLED : ALPI_PROBE_INVALID;
        ALP_TRY(alpi_tick(s->context, "probes", i, v->count));
    }
    return ALP_OK;
}
