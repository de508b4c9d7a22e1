// SPDX-License-Identifier: MIT
// Light at probes: sampled where they stand, or beside it for probes in solids.
#include "base/memory.h"
#include "base/tasks.h"
#include "fields/probes/probes.h"
#include "fields/truth.h"

#include <math.h>
#include <string.h>

enum { DIRECTIONS = 26, STEPS = 3, SURVEY_FACE = 4, CHUNK = 1024 /* probes that move at a time */ };
/// A probe is moved by at most this share of a cell, along each axis.
static const float MOVE_LIMIT = 0.45f;

static bool is_inside(const alpi_sphere_light *light)
{
    return light->behind > ALPI_FREE_BACKS;
}

alpi_sphere_rays alpi_probe_survey_rays(const alpi_probe_sampling *s)
{
    alpi_sphere_rays rays = s->rays;
    rays.from.light = (alpi_surface_light){0};
    rays.from.emitters = rays.from.sky = false;
    rays.aimed = NULL;
    rays.face = SURVEY_FACE;
    rays.replicates = ALPI_SPHERE_REPLICATES_LEAST;
    return rays;
}

static alp_result gather(const alpi_probe_sampling *s, const alpi_sphere_job *job,
                         const char *stage)
{
    const alpi_task_progress progress = {
        .callback = s->options->progress, .user = s->options->progress_user, .stage = stage};
    return alpi_sphere_gather(job, &progress);
}

// --- probes in solids ----------------------------------------------------------------------------

/// Direction i of the 26 of a lattice.
static void direction(int i, int way[3])
{
    const int number = i < DIRECTIONS / 2 ? i : i + 1; // without the middle
    way[0] = number % 3 - 1;
    way[1] = number / 3 % 3 - 1;
    way[2] = number / 9 - 1;
}

/// Places beside a probe: 26 directions of the lattice at a distance.
static void list_places(const alpi_probe_volume *v, const float point[3], int step,
                        float (*places)[3])
{
    const float part = MOVE_LIMIT * (float)(step + 1) / STEPS;
    for (int i = 0; i < DIRECTIONS; i++) {
        int way[3];
        direction(i, way);
        for (int k = 0; k < 3; k++) {
            places[i][k] = point[k] + part * v->spacing[k] * (float)way[k];
        }
    }
}

/// The free place that is nearest, and of those as near the one farthest from surfaces; −1: none
static int choose_place(const alpi_sphere_light *light)
{
    int best = -1, best_square = 4;
    for (int i = 0; i < DIRECTIONS; i++) {
        int way[3];
        direction(i, way);
        const int square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
        const bool better =
            square < best_square ||
            (square == best_square && light[i].front_distance > light[best].front_distance);
        if (!is_inside(&light[i]) && better) {
            best = i;
            best_square = square;
        }
    }
    return best;
}

/// Moves those of some probes for which a place is free at a distance. Takes them off the list.
static alp_result move_step(alpi_probe_sampling *s, alpi_probe_volume *v, int step, uint32_t *list,
                            uint32_t *count, float (*places)[3], alpi_sphere_light *light)
{
    const alpi_sphere_rays survey = alpi_probe_survey_rays(s);
    uint32_t left = 0;
    for (uint32_t i = 0; i < *count; i++) {
        list_places(v, s->points[list[i]], step, places + (size_t)i * DIRECTIONS);
    }
    const alpi_sphere_job job = {.rays = &survey,
                                 .points = (const float(*)[3])places,
                                 .count = *count * DIRECTIONS,
                                 .values = light};
    ALP_TRY(gather(s, &job, "moves"));
    for (uint32_t i = 0; i < *count; i++) {
        const uint32_t probe = list[i];
        const int best = choose_place(light + (size_t)i * DIRECTIONS);
        if (best < 0) {
            list[left++] = probe;
            continue;
        }
        const float *place = places[(size_t)i * DIRECTIONS + (size_t)best];
        for (int k = 0; k < 3; k++) {
            v->moves[probe][k] = place[k] - s->points[probe][k];
        }
        memcpy(s->points[probe], place, sizeof s->points[probe]);
        v->states[probe] = ALPI_PROBE_MOVED;
    }
    *count = left;
    return ALP_OK;
}

/// Whether a free place may lie within a move: the solid's surface does.
static bool may_move(const alpi_probe_volume *v, const alpi_sphere_light *light)
{
    return !v->is_list && light->back_distance <= MOVE_LIMIT * vec3_length(vec3_load(v->spacing));
}

static alp_result move_probes(alpi_probe_sampling *s, alpi_probe_volume *v, float (*places)[3],
                              alpi_sphere_light *light)
{
    uint32_t list[CHUNK], count = 0;
    for (uint32_t i = 0; i < v->count; i++) {
        if (v->states[i] == ALPI_PROBE_INVALID && may_move(v, &s->values[i])) {
            list[count++] = i;
        }
        if (count < CHUNK && i + 1 < v->count) {
            continue;
        }
        for (int step = 0; step < STEPS && count > 0; step++) {
            ALP_TRY(move_step(s, v, step, list, &count, places, light));
        }
        count = 0;
    }
    return ALP_OK;
}

/// Finds the probes in solids, and moves those that can be.
static alp_result survey_probes(alpi_probe_sampling *s, alpi_probe_volume *v)
{
    const alpi_sphere_rays survey = alpi_probe_survey_rays(s);
    const alpi_sphere_job job = {.rays = &survey,
                                 .points = (const float(*)[3])s->points,
                                 .count = v->count,
                                 .values = s->values};
    ALP_TRY(gather(s, &job, "survey"));
    for (uint32_t i = 0; i < v->count; i++) {
        v->states[i] = is_inside(&s->values[i]) ? ALPI_PROBE_INVALID : ALPI_PROBE_VALID;
    }
    float(*places)[3] = alpi_allocate(s->context, (size_t)CHUNK * DIRECTIONS, sizeof *places);
    alpi_sphere_light *light =
        ALPI_NEW(s->context, alpi_sphere_light, (size_t)CHUNK * DIRECTIONS);
    const alp_result result = places != NULL && light != NULL ? move_probes(s, v, places, light)
                                                              : ALP_ERROR_OUT_OF_MEMORY;
    alpi_release(s->context, light);
    alpi_release(s->context, places);
    return result;
}

// --- light ---------------------------------------------------------------------------------------

static alp_result sample(alpi_probe_sampling *s, alpi_probe_volume *v, uint32_t *free_probes)
{
    uint32_t count = 0;
    ALP_TRY(survey_probes(s, v));
    for (uint32_t i = 0; i < v->count; i++) {
        if (v->states[i] != ALPI_PROBE_INVALID) {
            free_probes[count++] = i;
        }
    }
    const alpi_sphere_job job = {.rays = &s->rays,
                                 .points = (const float(*)[3])s->points,
                                 .list = free_probes,
                                 .count = count,
                                 .values = s->values,
                                 .moments = v->moments};
    ALP_TRY(gather(s, &job, "probes"));
    for (uint32_t i = 0; i < count; i++) {
        const size_t probe = free_probes[i];
        alpi_probe_project(&s->values[probe].light, v->basis,
                           (float(*)[3])(v->coefficients + probe * v->coefficient_count * 3));
    }
    return ALP_OK;
}

alp_result alpi_probes_sample(alpi_probe_sampling *s, alpi_probe_volume *v)
{
    uint32_t *free_probes = ALPI_NEW(s->context, uint32_t, v->count);
    const alp_result result =
        free_probes != NULL ? sample(s, v, free_probes) : ALP_ERROR_OUT_OF_MEMORY;
    alpi_release(s->context, free_probes);
    return result;
}
