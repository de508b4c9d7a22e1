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
/// A probe nearer to a surface than this share of a cell lies on it: its rays may start on either
/// side.
static const float ON_SURFACE = 1e-3f;
/// Largest share of the sphere that black backs may fill at a place that a probe is moved to.
/// Beyond an edge of a wall without thickness, they fill an eighth.
static const float MOVED_BACKS = 0.05f;

static bool is_inside(const alpi_sphere_light *light)
{
    return light->behind > ALPI_FREE_BACKS;
}

static float nearest_surface(const alpi_sphere_light *light)
{
    return fminf(light->front_distance, light->back_distance);
}

static bool is_on_surface(const alpi_probe_volume *v, const alpi_sphere_light *light)
{
    return !v->is_list && nearest_surface(light) < ON_SURFACE * v->spacing[0];
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

/// Beyond the bounds of the scene few rays meet backs, but there is no light that a room needs.
static bool is_within(const alp_scene *scene, const float place[3])
{
    const vec3 low = scene->bounds_min, high = scene->bounds_max;
    return place[0] >= low.x && place[1] >= low.y && place[2] >= low.z && place[0] <= high.x &&
           place[1] <= high.y && place[2] <= high.z;
}

/// Whether a few rays show a place to lie in a solid: three of eight meet black backs.
static bool shows_backs(const alpi_probe_sampling *s, const float place[3])
{
    enum { MOST = 2 };
    const alpi_gather_scene *from = &s->rays.from;
    const float corner = 0.57735027f; // 1/√3
    alpi_rays rays;
    alpi_hits hits;
    uint32_t backs = 0;
    alpi_rays_start(&rays, vec3_load(place));
    for (int i = 0; i < ALPI_PACKET; i++) {
        rays.direction_x[i] = (i & 1) != 0 ? corner : -corner;
        rays.direction_y[i] = (i & 2) != 0 ? corner : -corner;
        rays.direction_z[i] = (i & 4) != 0 ? corner : -corner;
    }
    alpi_trace_nearest(from->tracer, &rays, 0xffu, from->filter, &hits);
    for (int i = 0; i < ALPI_PACKET; i++) {
        const bool behind = hits.triangle[i] != ALPI_NONE && (hits.behind >> i & 1u) != 0;
        backs += behind && !alpi_surface_is_double_sided(from->scene, hits.triangle[i]);
    }
    return backs > MOST;
}

/// Places beside probes of a list, of which few rays tell which are worth more.
typedef struct place_test {
    const alpi_probe_sampling *sampling;
    const uint32_t *list;
    const float (*places)[3];
    alpi_sphere_light *light; // out: `behind` is 1 of those that are not
} place_test;

static alp_result test_places(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const place_test *test = user;
    const alpi_probe_sampling *s = test->sampling;
    for (uint32_t i = begin * DIRECTIONS; i < end * DIRECTIONS; i++) {
        const uint32_t probe = test->list[i / DIRECTIONS];
        const float *place = test->places[i];
        const vec3 way = vec3_sub(vec3_load(place), vec3_load(s->points[probe]));
        // No place within the nearest surface is free; that is known to a few hundredths.
        const bool near = vec3_length(way) < 0.9f * nearest_surface(&s->values[probe]);
        const bool out = near || !is_within(s->rays.from.scene, place) || shows_backs(s, place);
        test->light[i].behind = out ? 1.0f : 0.0f;
    }
    return ALP_OK;
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
        if (better && light[i].behind <= MOVED_BACKS) {
            best = i;
            best_square = square;
        }
    }
    return best;
}

/// Room for moves: CHUNK × DIRECTIONS of each.
typedef struct move_work {
    float (*places)[3];
    alpi_sphere_light *light;
    uint32_t *worth; // places that are surveyed
} move_work;

/// Surveys the places beside probes of a list at a distance.
static alp_result survey_places(const alpi_probe_sampling *s, const alpi_probe_volume *v, int step,
                                const uint32_t *list, uint32_t count, const move_work *w)
{
    const alpi_sphere_rays survey = alpi_probe_survey_rays(s);
    const alpi_task_progress progress = {
        .callback = s->options->progress, .user = s->options->progress_user, .stage = "moves"};
    uint32_t worth = 0;
    for (uint32_t i = 0; i < count; i++) {
        list_places(v, s->points[list[i]], step, w->places + (size_t)i * DIRECTIONS);
    }
    place_test test = {s, list, (const float(*)[3])w->places, w->light};
    ALP_TRY(alpi_parallel_for(s->context, count, 16, test_places, &test, &progress));
    for (uint32_t i = 0; i < count * DIRECTIONS; i++) {
        if (w->light[i].behind < 1.0f) {
            w->worth[worth++] = i;
        }
    }
    const alpi_sphere_job job = {.rays = &survey,
                                 .points = (const float(*)[3])w->places,
                                 .list = w->worth,
                                 .count = worth,
                                 .values = w->light};
    return gather(s, &job, "moves");
}

/// Moves those of some probes for which a place is free at a distance. Takes them off the list.
static alp_result move_step(alpi_probe_sampling *s, alpi_probe_volume *v, int step, uint32_t *list,
                            uint32_t *count, const move_work *w)
{
    uint32_t left = 0;
    ALP_TRY(survey_places(s, v, step, list, *count, w));
    for (uint32_t i = 0; i < *count; i++) {
        const uint32_t probe = list[i];
        const int best = choose_place(w->light + (size_t)i * DIRECTIONS);
        if (best < 0) {
            list[left++] = probe;
            continue;
        }
        const float *place = w->places[(size_t)i * DIRECTIONS + (size_t)best];
        for (int k = 0; k < 3; k++) {
            v->moves[probe][k] = place[k] - s->points[probe][k];
        }
        memcpy(s->points[probe], place, sizeof s->points[probe]);
        v->states[probe] = ALPI_PROBE_MOVED;
    }
    *count = left;
    return ALP_OK;
}

/// Whether a free place may lie within a move: the surface of the solid does.
static bool may_move(const alpi_probe_volume *v, const alpi_sphere_light *light)
{
    return !v->is_list && nearest_surface(light) <= MOVE_LIMIT * vec3_length(vec3_load(v->spacing));
}

static alp_result move_probes(alpi_probe_sampling *s, alpi_probe_volume *v, const move_work *w)
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
            ALP_TRY(move_step(s, v, step, list, &count, w));
        }
        count = 0;
    }
    return ALP_OK;
}

/// Finds the probes in solids and on surfaces, and moves those that can be.
static alp_result survey_probes(alpi_probe_sampling *s, alpi_probe_volume *v)
{
    const alpi_sphere_rays survey = alpi_probe_survey_rays(s);
    const alpi_sphere_job job = {.rays = &survey,
                                 .points = (const float(*)[3])s->points,
                                 .count = v->count,
                                 .values = s->values};
    ALP_TRY(gather(s, &job, "survey"));
    for (uint32_t i = 0; i < v->count; i++) {
        const bool bad = is_inside(&s->values[i]) || is_on_surface(v, &s->values[i]);
        v->states[i] = bad ? ALPI_PROBE_INVALID : ALPI_PROBE_VALID;
    }
    const size_t places = (size_t)CHUNK * DIRECTIONS;
    const move_work work = {alpi_allocate(s->context, places, sizeof *work.places),
                            ALPI_NEW(s->context, alpi_sphere_light, places),
                            ALPI_NEW(s->context, uint32_t, places)};
    const bool room = work.places != NULL && work.light != NULL && work.worth != NULL;
    const alp_result result = room ? move_probes(s, v, &work) : ALP_ERROR_OUT_OF_MEMORY;
    alpi_release(s->context, work.worth);
    alpi_release(s->context, work.light);
    alpi_release(s->context, work.places);
    return result;
}

// --- light ---------------------------------------------------------------------------------------

alp_result alpi_probes_survey(alpi_probe_sampling *s, alpi_probe_volume *v)
{
    ALP_TRY(survey_probes(s, v));
    ALPI_TRY_NEW(s->context, s->free_probes, v->count);
    for (uint32_t i = 0; i < v->count; i++) {
        if (v->states[i] != ALPI_PROBE_INVALID) {
            s->free_probes[s->free_count++] = i;
        }
    }
    return ALP_OK;
}

alp_result alpi_probes_light(const alpi_probe_sampling *s, const alpi_probe_light *light,
                             alpi_probe_volume *v, float *coefficients)
{
    const alpi_sphere_job job = {.rays = &light->rays,
                                 .points = light->points,
                                 .list = s->free_probes,
                                 .count = s->free_count,
                                 .values = light->values,
                                 .moments = light->moments};
    ALP_TRY(gather(s, &job, light->stage));
    if (light->lamps != NULL) {
        const alpi_task_progress progress = {.callback = s->options->progress,
                                             .user = s->options->progress_user,
                                             .stage = light->stage};
        ALP_TRY(alpi_sphere_lamps_add(&(alpi_sphere_lamps){.rays = &light->rays,
                                                           .lighting = light->lamps,
                                                           .light = light->lamp,
                                                           .points = light->points,
                                                           .list = s->free_probes,
                                                           .count = s->free_count,
                                                           .values = light->values},
                                      &progress));
    }
    for (uint32_t i = 0; i < s->free_count; i++) {
        const size_t probe = s->free_probes[i];
        alpi_probe_project(&light->values[probe].light, v->basis,
                           (float(*)[3])(coefficients + probe * v->coefficient_count * 3));
    }
    return ALP_OK;
}

// --- gradients -----------------------------------------------------------------------------------

/// Half the distance of the two places of a difference, in cells.
static const float GRADIENT_STEP = 0.25f;

/// Room for a gradient along one axis.
typedef struct gradient_work {
    float (*points)[3]; // [count] on one side
    alpi_sphere_light *values;
    float *sides[2]; // [count][coefficient_count][3]
} gradient_work;

static alp_result find_gradient(const alpi_probe_sampling *s, const alpi_probe_light *light,
                                alpi_probe_volume *v, int axis, const gradient_work *work)
{
    const uint32_t floats = 3 * v->coefficient_count;
    const float step = GRADIENT_STEP * v->spacing[axis];
    alpi_probe_light side = *light;
    side.points = (const float(*)[3])work->points;
    side.values = work->values;
    side.moments = NULL;
    side.stage = "gradients";
    for (int k = 0; k < 2; k++) {
        memcpy(work->points, s->points, v->count * sizeof *work->points);
        for (uint32_t i = 0; i < v->count; i++) {
            work->points[i][axis] += k == 0 ? -step : step;
        }
        ALP_TRY(alpi_probes_light(s, &side, v, work->sides[k]));
    }
    for (uint32_t i = 0; i < s->free_count; i++) {
        const size_t probe = s->free_probes[i];
        // A wall nearer than the step would end in the difference.
        const float scale = nearest_surface(&s->values[probe]) > step ? 0.5f / step : 0.0f;
        for (size_t c = 0; c < floats; c++) {
            const size_t at = probe * floats + c;
            v->gradients[(probe * 3 + (size_t)axis) * floats + c] =
                scale * (work->sides[1][at] - work->sides[0][at]);
        }
    }
    return ALP_OK;
}

static alp_result find_gradients(const alpi_probe_sampling *s, const alpi_probe_light *light,
                                 alpi_probe_volume *v, gradient_work *work)
{
    const size_t values = (size_t)v->count * v->coefficient_count * 3;
    ALPI_TRY_NEW(s->context, work->points, v->count);
    ALPI_TRY_NEW(s->context, work->values, v->count);
    ALPI_TRY_NEW(s->context, work->sides[0], values);
    ALPI_TRY_NEW(s->context, work->sides[1], values);
    for (int axis = 0; axis < 3; axis++) {
        ALP_TRY(find_gradient(s, light, v, axis, work));
    }
    return ALP_OK;
}

alp_result alpi_probes_find_gradients(const alpi_probe_sampling *s, const alpi_probe_light *light,
                                      alpi_probe_volume *v)
{
    gradient_work work = {NULL, NULL, {NULL, NULL}};
    const alp_result result = find_gradients(s, light, v, &work);
    alpi_release(s->context, work.points);
    alpi_release(s->context, work.values);
    alpi_release(s->context, work.sides[0]);
    alpi_release(s->context, work.sides[1]);
    return result;
}
