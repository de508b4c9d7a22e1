// SPDX-License-Identifier: MIT
// Light of probes in solids, from valid neighbours. A reader that interpolates without visibility
// then finds no black probe beside a surface.
#include "base/memory.h"
#include "base/tasks.h"
#include "fields/probes/probes.h"

#include <stdlib.h>

/// Distance at which a ray from one point to another first meets a surface, metres.
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

enum { NEIGHBOURS = 98 }; // two cells away

/// Neighbours that a probe is filled from.
typedef struct neighbour_list {
    uint32_t count, probes[NEIGHBOURS];
    double weights[NEIGHBOURS], sum; // inverse squares of their distances
} neighbour_list;

/// Lists the valid neighbours of a probe that lie `reach` cells away.
static void list_neighbours(const alpi_probe_sampling *s, const alpi_probe_volume *v,
                            uint32_t index, int reach, neighbour_list *list)
{
    const int at[3] = {(int)(index % v->size[0]), (int)(index / v->size[0] % v->size[1]),
                       (int)(index / v->size[0] / v->size[1])};
    const vec3 probe = vec3_load(s->points[index]);
    const int side = 2 * reach + 1;
    for (int n = 0; n < side * side * side; n++) {
        const int way[3] = {n % side - reach, n / side % side - reach, n / side / side - reach};
        uint32_t other = 0, stride = 1;
        bool there = abs(way[0]) == reach || abs(way[1]) == reach || abs(way[2]) == reach;
        for (int k = 0; k < 3; k++) {
            const int to = at[k] + way[k];
            there = there && to >= 0 && to < (int)v->size[k];
            other += (uint32_t)(there ? to : 0) * stride;
            stride *= v->size[k];
        }
        if (!there || v->states[other] > ALPI_PROBE_MOVED) {
            continue;
        }
        const vec3 from = vec3_load(s->points[other]), apart = vec3_sub(from, probe);
        if (!sees(s, from, probe)) {
            continue;
        }
        const double weight = 1.0 / ((double)vec3_dot(apart, apart) + 1e-30);
        list->probes[list->count] = other;
        list->weights[list->count++] = weight;
        list->sum += weight;
    }
}

/// Writes the mean of neighbours.
static void fill_from(const neighbour_list *list, uint32_t probe, uint32_t floats,
                      float *coefficients)
{
    double sums[3 * ALPI_SH9_COUNT] = {0.0};
    for (uint32_t n = 0; n < list->count; n++) {
        const float *c = coefficients + (size_t)list->probes[n] * floats;
        for (uint32_t i = 0; i < floats; i++) {
            sums[i] += list->weights[n] * (double)c[i];
        }
    }
    for (uint32_t i = 0; i < floats; i++) {
        coefficients[(size_t)probe * floats + i] = (float)(sums[i] / list->sum);
    }
}

typedef struct fill_job {
    const alpi_probe_sampling *sampling;
    alpi_probe_volume *volume;
    uint8_t *filled; // [count] the states of all while they are read
} fill_job;

static alp_result fill_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const fill_job *job = user;
    const alpi_probe_volume *v = job->volume;
    const uint32_t floats = 3 * v->coefficient_count;
    for (uint32_t i = begin; i < end; i++) {
        neighbour_list list = {.count = 0};
        if (v->states[i] != ALPI_PROBE_INVALID) {
            continue;
        }
        for (int reach = 1; reach <= 2 && list.count == 0; reach++) {
            list_neighbours(job->sampling, v, i, reach, &list);
        }
        if (list.count > 0) {
            fill_from(&list, i, floats, v->coefficients);
            for (uint32_t l = 0; l < v->layer_count; l++) {
                fill_from(&list, i, floats, v->layers[l].coefficients);
            }
        }
        job->filled[i] = list.count > 0;
    }
    return ALP_OK;
}

alp_result alpi_probes_fill(const alpi_probe_sampling *s, alpi_probe_volume *v)
{
    const alpi_task_progress progress = {
        .callback = s->options->progress, .user = s->options->progress_user, .stage = "fill"};
    if (v->is_list) {
        return ALP_OK;
    }
    fill_job job = {s, v, ALPI_NEW(s->context, uint8_t, v->count)};
    if (job.filled == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result =
        alpi_parallel_for(s->context, v->count, 64, fill_range, &job, &progress);
    for (uint32_t i = 0; i < v->count; i++) {
        v->states[i] = job.filled[i] != 0 ? ALPI_PROBE_FILLED : v->states[i];
    }
    alpi_release(s->context, job.filled);
    return result;
}
