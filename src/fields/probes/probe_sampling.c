// SPDX-License-Identifier: MIT
// Light at probes: sampled where they stand, or beside it for probes in solids.
#include "base/memory.h"
#include "base/tasks.h"
#include "fields/probes/probes.h"
#include "fields/truth.h"

#include <math.h>
#include <string.h>

enum { DIRECTIONS = 26, STEPS = 3, SURVEY_FACE = 4 };
/// A probe is moved by at most this share of a cell, along each axis.
static const float MOVE_LIMIT = 0.45f;

static bool is_inside(const alpi_sphere_light *light)
{
    return light->behind > ALPI_FREE_BACKS;
}

/// Places beside a probe, nearest first: 26 directions of the lattice at three distances.
static void list_places(const alpi_probe_volume *v, const float place[3], int step,
                        float (*places)[3])
{
    const float part = MOVE_LIMIT * (float)(step + 1) / STEPS;
    for (int i = 0; i < DIRECTIONS; i++) {
        const int number = i < DIRECTIONS / 2 ? i : i + 1; // without the middle
        const int way[3] = {number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1};
        for (int k = 0; k < 3; k++) {
            places[i][k] = place[k] + part * v->spacing[k] * (float)way[k];
        }
    }
}

static float length_of_way(int i)
{
    const int number = i < DIRECTIONS / 2 ? i : i + 1;
    const int x = number % 3 - 1, y = number / 3 % 3 - 1, z = number / 9 - 1;
    return sqrtf((float)(x * x + y * y + z * z));
}

/// The free place beside a probe that is nearest, and of those alike the one farthest from
/// surfaces. @return false: there is none
static alp_result find_place(const alpi_probe_sampling *s, const alpi_probe_volume *v,
                             const float place[3], float found[3], bool *any)
{
    alpi_sphere_rays survey = s->rays;
    survey.from.light = (alpi_surface_light){0};
    survey.from.emitters = survey.from.sky = false;
    survey.aimed = NULL;
    survey.face = SURVEY_FACE;
    survey.replicates = ALPI_SPHERE_REPLICATES_LEAST;
    float places[DIRECTIONS][3];
    alpi_sphere_light light[DIRECTIONS];
    *any = false;
    for (int step = 0; step < STEPS && !*any; step++) {
        float best_length = INFINITY, best_room = -1.0f;
        list_places(v, place, step, places);
        const alpi_sphere_job job = {.rays = &survey,
                                     .points = (const float(*)[3])places,
                                     .count = DIRECTIONS,
                                     .values = light};
        ALP_TRY(alpi_sphere_gather(&job, NULL));
        for (int i = 0; i < DIRECTIONS; i++) {
            const float length = length_of_way(i), room = light[i].front_distance;
            const bool nearer = length < best_length - 1e-3f;
            if (!is_inside(&light[i]) &&
                (nearer || (length < best_length + 1e-3f && room > best_room))) {
                best_length = length;
                best_room = room;
                memcpy(found, places[i], sizeof places[i]);
                *any = true;
            }
        }
    }
    return ALP_OK;
}

/// Moves probes that lie in solids, as far as there is a free place. @param list out: moved probes
static alp_result move_probes(alpi_probe_sampling *s, alpi_probe_volume *v, uint32_t *list,
                              uint32_t *count)
{
    for (uint32_t i = 0; i < v->count; i++) {
        if (!is_inside(&s->values[i])) {
            continue;
        }
        float found[3];
        bool any = false;
        if (!v->is_list) {
            ALP_TRY(find_place(s, v, s->points[i], found, &any));
        }
        v->states[i] = any ? ALPI_PROBE_MOVED : ALPI_PROBE_INVALID;
        for (int k = 0; k < 3 && any; k++) {
            v->moves[i][k] = found[k] - s->points[i][k];
            s->points[i][k] = found[k];
        }
        if (any) {
            list[(*count)++] = i;
        }
        ALP_TRY(alpi_tick(s->context, "probes", i, v->count));
    }
    return ALP_OK;
}

static alp_result gather(const alpi_probe_sampling *s, alpi_probe_volume *v, const uint32_t *list,
                         uint32_t count)
{
    const alpi_sphere_job job = {.rays = &s->rays,
                                 .points = (const float(*)[3])s->points,
                                 .list = list,
                                 .count = count,
                                 .values = s->values,
                                 .moments = v->moments};
    const alpi_task_progress progress = {.callback = s->options->progress,
                                         .user = s->options->progress_user,
                                         .stage = "probes"};
    return alpi_sphere_gather(&job, &progress);
}

static alp_result sample(alpi_probe_sampling *s, alpi_probe_volume *v, uint32_t *moved)
{
    uint32_t count = 0;
    ALP_TRY(gather(s, v, NULL, v->count));
    ALP_TRY(move_probes(s, v, moved, &count));
    ALP_TRY(gather(s, v, moved, count));
    for (uint32_t i = 0; i < v->count; i++) {
        float(*c)[3] = (float(*)[3])(v->coefficients + (size_t)i * v->coefficient_count * 3);
        if (v->states[i] != ALPI_PROBE_INVALID) {
            alpi_probe_project(&s->values[i].light, v->basis, c);
        }
    }
    return ALP_OK;
}

alp_result alpi_probes_sample(alpi_probe_sampling *s, alpi_probe_volume *v)
{
    uint32_t *moved = ALPI_NEW(s->context, uint32_t, v->count);
    const alp_result result = moved != NULL ? sample(s, v, moved) : ALP_ERROR_OUT_OF_MEMORY;
    alpi_release(s->context, moved);
    return result;
}
