// SPDX-License-Identifier: MIT
#include "ambience_world.h"

#include "fields/truth.h"
#include "transport/sphere/sphere_hits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GROUND_CELLS = 240, TREES = 160, FACE = 16, QUICK_FACE = 4, TEST_FACE = 8 };
enum { POINTS = 64, QUICK_POINTS = 4, BATCH = 64, ATTEMPTS = 400 };

// --- the world -----------------------------------------------------------------------------------

static alp_result light_world(ambience_world *w, bool terrain)
{
    w->light = alp_lighting_options_default();
    w->light.sky.kind = ALP_SKY_CLEAR;
    w->light.sun.illuminance = 60000.0f;
    w->light.sun.elevation = 0.7f;
    w->light.sun.azimuth = 2.2f;
    ALP_TRY(alpi_lighting_create_quietly(w->scene.scene, &w->light, &w->lighting));
    return terrain ? alpi_terrain_make_ground(w->scene.context, GROUND_CELLS, &w->ground) : ALP_OK;
}

bool ambience_world_open(const char *name, uint32_t workers, bool quick, ambience_world *world)
{
    *world = (ambience_world){.quick = quick};
    if (!bench_scene_open(name, workers, &world->scene)) {
        return false;
    }
    const bool terrain = strncmp(name, "builtin:terrain", strlen("builtin:terrain")) == 0;
    if (!bench_good(&world->scene, light_world(world, terrain))) {
        ambience_world_close(world);
        return false;
    }
    return true;
}

void ambience_world_close(ambience_world *world)
{
    if (world->scene.context != NULL) {
        alpi_terrain_destroy_ground(world->scene.context, world->ground);
        alpi_lighting_destroy(world->scene.context, world->lighting);
        bench_scene_close(&world->scene);
    }
    *world = (ambience_world){0};
}

// --- flights --------------------------------------------------------------------------

/// Metres of the ground, mean of a square of 24 m.
static double smooth_ground(const ambience_world *w, double x, double z)
{
    double sum = 0.0;
    for (int i = 0; i < 25; i++) {
        const int column = i % 5 - 2, row = i / 5 - 2;
        const double dx = 6.0 * column, dz = 6.0 * row;
        sum += (double)alpi_terrain_height(w->ground, (float)(x + dx), (float)(z + dz));
    }
    return fmax(sum / 25.0, 0.0);
}

/// Seen from above: a line over the lake and between houses; circles round hills and woods, and
/// high over all.
static void flight_place(const ambience_world *w, int flight, double seconds, double place[3])
{
    static const struct {
        double x, z; // where a line starts, or the middle of a circle
        double radius, angle, above;
    } flights[WORLD_FLIGHTS] = {{-80.0, 56.5, 0.0, -0.4444, 4.0},
                                {0.0, 6.0, 82.0, 0.4, 6.0},
                                {16.0, -6.0, 58.0, 4.0, 14.0}};
    const double radius = flights[flight].radius, flown = WORLD_SPEED * seconds;
    const double angle = flights[flight].angle + (radius > 0.0 ? flown / radius : 0.0);
    const double away = radius > 0.0 ? radius : flown;
    place[0] = flights[flight].x + away * cos(angle);
    place[2] = flights[flight].z + away * sin(angle);
    place[1] = smooth_ground(w, place[0], place[2]) + flights[flight].above;
}

void ambience_world_fly(const ambience_world *world, int flight, double time,
                        alp_ambience_camera *camera)
{
    const double flown = time - WORLD_STANDS, step = 1e-3;
    const double seconds = fmin(fmax(flown, 0.0), WORLD_FLIES);
    double ahead[3];
    *camera = (alp_ambience_camera){.vfov = 1.0};
    flight_place(world, flight, seconds, camera->position);
    flight_place(world, flight, seconds + step, ahead);
    for (int k = 0; k < 3; k++) {
        camera->forward[k] = (ahead[k] - camera->position[k]) / step;
        camera->velocity[k] = flown > 0.0 && flown < WORLD_FLIES ? camera->forward[k] : 0.0;
    }
}

/// The tree with the most others within 9 m.
static vec3 find_wood(const ambience_world *w)
{
    vec3 trees[TREES], best = {0.0f, 0.0f, 0.0f};
    int most = -1;
    for (uint32_t i = 0; i < TREES; i++) {
        trees[i] = alpi_terrain_tree(w->ground, i);
    }
    for (int i = 0; i < TREES; i++) {
        int near = 0;
        vec3 sum = {0.0f, 0.0f, 0.0f};
        for (int k = 0; k < TREES; k++) {
            if (hypotf(trees[k].x - trees[i].x, trees[k].z - trees[i].z) < 9.0f) {
                sum = vec3_add(sum, trees[k]);
                near++;
            }
        }
        if (near > most) {
            most = near;
            best = vec3_scale(sum, 1.0f / (float)near);
        }
    }
    return best;
}

/// A place between the nearest two houses: their middle, or 1.2 m from a wall of the first.
static void find_alley(bool at_wall, double place[3])
{
    const alpi_house *a = &alpi_terrain_houses()[1], *b = &alpi_terrain_houses()[2];
    const double x = (double)(b->x - a->x), z = (double)(b->z - a->z);
    const double c = cos((double)a->turn), s = sin((double)a->turn);
    // The way to the other house in the house's own axes, scaled to its walls.
    const double along = fabs(c * x - s * z) / (0.5 * (double)a->width);
    const double across = fabs(s * x + c * z) / (0.5 * (double)a->length);
    const double wall = 1.0 / fmax(along, across) + 1.2 / hypot(x, z);
    const double share = at_wall ? wall : 0.5;
    place[0] = (double)a->x + share * x;
    place[2] = (double)a->z + share * z;
    place[1] = (double)alpi_terrain_pad(a);
}

// --- light at points -----------------------------------------------------------------------------

static void read_bounce(const void *user, uint32_t count, const vec3 *points, const vec3 *normals,
                        vec3 *irradiance)
{
    for (uint32_t i = 0; i < count; i++) {
        const double place[3] = {(double)points[i].x, (double)points[i].y, (double)points[i].z};
        alpi_sh9 radiance;
        alp_ambience_coefficients(user, place, &radiance);
        const vec3 e = alpi_sh9_irradiance(&radiance, normals[i]);
        irradiance[i] = (vec3){fmaxf(e.x, 0.0f), fmaxf(e.y, 0.0f), fmaxf(e.z, 0.0f)};
    }
}

static bool gather(const ambience_world *w, const alp_ambience_snapshot *bounced, uint32_t count,
                   alpi_sphere_hits_point *points)
{
    const alpi_sphere_relight how = {
        .context = w->scene.context,
        .scene = w->scene.scene,
        .tracer = w->scene.tracer,
        .lighting = w->lighting,
        .bounce = bounced != NULL ? read_bounce : NULL,
        .bounce_user = bounced,
        .bounce_cell_scale = 0.3f,
        .bounce_cell_least = 1.0f,
    };
    return bench_good(&w->scene, alpi_sphere_hits_gather(&how, points, count, NULL));
}

bool ambience_world_sample(const ambience_world *world, const alp_ambience_snapshot *bounced,
                           uint32_t count, const double (*positions)[3], alpi_sh9 *lights,
                           bool *solid)
{
    alpi_sphere_hits_point batch[BATCH];
    for (uint32_t first = 0; first < count; first += BATCH) {
        const uint32_t some = count - first < BATCH ? count - first : BATCH;
        for (uint32_t i = 0; i < some; i++) {
            const double *p = positions[first + i];
            batch[i] = (alpi_sphere_hits_point){
                .point = {(float)p[0], (float)p[1], (float)p[2]},
                .key = first + i,
                .face = world->quick ? QUICK_FACE : FACE,
            };
        }
        if (!gather(world, bounced, some, batch)) {
            return false;
        }
        for (uint32_t i = 0; i < some; i++) {
            lights[first + i] = batch[i].value.light;
            if (solid != NULL) {
                solid[first + i] = batch[i].value.behind > ALPI_FREE_BACKS;
            }
        }
    }
    return true;
}

// --- places --------------------------------------------------------------------------------------

/// Sets the height to that of eyes.
static void raise_place(const ambience_world *w, double place[3])
{
    const double ground = (double)alpi_terrain_height(w->ground, (float)place[0], (float)place[2]);
    place[1] = fmax(ground, 0.0) + 1.7;
}

/// Moves a place by 3 m at most, to the freest of 49.
static void find_clearing(const ambience_world *w, double place[3])
{
    enum { SIDE = 7 };
    alpi_sphere_hits_point points[SIDE * SIDE];
    float most = 0.0f;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int column = i % SIDE - SIDE / 2, row = i / SIDE - SIDE / 2;
        double at[3] = {place[0] + column, 0.0, place[2] + row};
        raise_place(w, at);
        points[i] = (alpi_sphere_hits_point){.point = {(float)at[0], (float)at[1], (float)at[2]},
                                             .face = TEST_FACE};
    }
    if (!gather(w, NULL, SIDE * SIDE, points)) {
        return;
    }
    for (int i = 0; i < SIDE * SIDE; i++) {
        const alpi_sphere_light *l = &points[i].value;
        if (l->behind <= 0.0f && l->front_distance > most) {
            most = l->front_distance;
            place[0] = (double)points[i].point.x;
            place[1] = (double)points[i].point.y;
            place[2] = (double)points[i].point.z;
        }
    }
}

ambience_place ambience_world_place(const ambience_world *world, int place)
{
    static const char *const names[WORLD_PLACES] = {"alley", "wall", "wood", "shore"};
    ambience_place p = {.name = names[place]};
    if (place < 2) {
        find_alley(place == 1, p.position);
    } else if (place == 2) {
        const vec3 wood = find_wood(world);
        p.position[0] = (double)wood.x;
        p.position[2] = (double)wood.z;
    } else {
        p.position[0] = (double)ALPI_LAKE_X + 22.0;
        p.position[2] = (double)ALPI_LAKE_Z + 5.0;
    }
    raise_place(world, p.position);
    if (place == 2) {
        find_clearing(world, p.position);
    }
    return p;
}

// --- points with their truth ---------------------------------------------------------------------

double ambience_world_draw(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

/// A place in the ball of radius 1.
static void draw_in_ball(uint64_t *state, double place[3])
{
    double square;
    do {
        square = 0.0;
        for (int k = 0; k < 3; k++) {
            place[k] = 2.0 * ambience_world_draw(state) - 1.0;
            square += place[k] * place[k];
        }
    } while (square > 1.0 || square < 1e-6);
}

/// Below the terrain's ground, or in the hollow under its lake.
static bool is_buried(const ambience_world *w, const double place[3])
{
    return w->ground != NULL &&
           place[1] <
               fmax((double)alpi_terrain_height(w->ground, (float)place[0], (float)place[2]), 0.0);
}

/// Draws a batch of places, and keeps the free ones.
static bool add_free(const ambience_world *w, const double centre[3], double reach, uint64_t *state,
                     ambience_points *points, uint32_t wanted)
{
    alpi_sphere_hits_point batch[BATCH];
    double places[BATCH][3];
    for (int i = 0; i < BATCH; i++) {
        draw_in_ball(state, places[i]);
        for (int k = 0; k < 3; k++) {
            places[i][k] = centre[k] + reach * places[i][k];
        }
        batch[i] = (alpi_sphere_hits_point){
            .point = {(float)places[i][0], (float)places[i][1], (float)places[i][2]},
            .face = TEST_FACE};
    }
    if (!gather(w, NULL, BATCH, batch)) {
        return false;
    }
    for (int i = 0; i < BATCH && points->count < wanted; i++) {
        if (batch[i].value.behind <= ALPI_FREE_BACKS && !is_buried(w, places[i])) {
            double normal[3];
            draw_in_ball(state, normal);
            const double length =
                sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
            for (int k = 0; k < 3; k++) {
                points->normals[points->count][k] = (float)(normal[k] / length);
            }
            memcpy(points->positions[points->count++], places[i], sizeof places[i]);
        }
    }
    return true;
}

static alp_result trace_truth(const ambience_world *w, uint32_t paths, ambience_points *p)
{
    alp_reference_options o = alp_reference_options_default();
    float(*places)[3] = bench_allocate(p->count, sizeof *places);
    float(*errors)[3] = bench_allocate(p->count, sizeof *errors);
    o.lighting = w->light;
    o.samples = paths;
    for (uint32_t i = 0; i < p->count; i++) {
        for (int k = 0; k < 3; k++) {
            places[i][k] = (float)p->positions[i][k];
        }
    }
    const alp_result result =
        alp_reference_irradiance(w->scene.scene, &o, p->count, (const float(*)[3])places,
                                 (const float(*)[3])p->normals, p->truth, errors);
    for (uint32_t i = 0; i < 3 * p->count; i++) {
        p->mean += (double)p->truth[i / 3][i % 3] / (3.0 * p->count);
        p->own += (double)errors[i / 3][i % 3] / (3.0 * p->count);
    }
    p->own /= p->mean;
    free(places);
    free(errors);
    return result;
}

bool ambience_points_open(const ambience_world *world, const double centre[3], double reach,
                          uint32_t seed, uint32_t paths, ambience_points *points)
{
    const uint32_t wanted = world->quick ? QUICK_POINTS : POINTS;
    uint64_t state = seed;
    *points = (ambience_points){.positions = bench_allocate(wanted, sizeof *points->positions),
                                .normals = bench_allocate(wanted, sizeof *points->normals),
                                .truth = bench_allocate(wanted, sizeof *points->truth),
                                .values = bench_allocate(wanted, sizeof *points->values)};
    bool good = true;
    for (int i = 0; i < ATTEMPTS && good && points->count < wanted; i++) {
        good = add_free(world, centre, reach, &state, points, wanted);
    }
    if (good && points->count < wanted) {
        fprintf(stderr, "alpenglow bench: no free points there\n");
        good = false;
    }
    good = good && bench_good(&world->scene, trace_truth(world, paths, points));
    if (!good) {
        ambience_points_close(points);
    }
    return good;
}

void ambience_points_close(ambience_points *points)
{
    free(points->positions);
    free(points->normals);
    free(points->truth);
    free(points->values);
    *points = (ambience_points){0};
}

ambience_verdict ambience_points_judge(const ambience_points *points)
{
    double apart = 0.0, sum = 0.0;
    for (uint32_t i = 0; i < 3 * points->count; i++) {
        const double d = (double)points->values[i / 3][i % 3] - (double)points->truth[i / 3][i % 3];
        apart += fabs(d);
        sum += d;
    }
    const double all = 3.0 * points->count * points->mean;
    return (ambience_verdict){100.0 * apart / all, 100.0 * sum / all};
}

// --- volumes -------------------------------------------------------------------------------------

void ambience_view_read(const alp_ambience_snapshot *snapshot, ambience_view view, uint32_t count,
                        const double (*positions)[3], const float (*normals)[3], float (*values)[3])
{
    alp_ambience_snapshot changed = {.read = snapshot->read};
    memcpy(&changed, snapshot, offsetof(alp_ambience_snapshot, readers));
    changed.moments = view == VIEW_OURS ? changed.moments : NULL;
    changed.lookup = view == VIEW_CONFORMANCE ? ALP_AMBIENCE_CONFORMANCE : changed.lookup;
    alp_ambience_irradiance(&changed, count, positions, normals, values);
}

bool ambience_run_open(const ambience_world *world, const alp_ambience_options *options,
                       ambience_run *run)
{
    alp_ambience_sampler_options o = alp_ambience_sampler_options_default();
    o.lighting = world->light;
    o.face = world->quick ? QUICK_FACE : o.face;
    o.first_face = world->quick ? QUICK_FACE : o.first_face;
    *run = (ambience_run){0};
    alp_result result = alp_ambience_create(world->scene.context, options, &run->ambience);
    if (result == ALP_OK) {
        result = alp_ambience_sampler_create(run->ambience, world->scene.scene, &o, &run->sampler);
    }
    if (result != ALP_OK) {
        ambience_run_close(run);
    }
    return bench_good(&world->scene, result);
}

bool ambience_run_step(const ambience_world *world, ambience_run *run, double time,
                       const alp_ambience_camera *camera, uint32_t samples)
{
    alp_ambience_work work = {0};
    const double started = bench_process_seconds();
    alp_result result = alp_ambience_update(run->ambience, time);
    if (result == ALP_OK) {
        result = alp_ambience_sample(run->sampler, camera, samples, 0.0, &work);
    }
    run->samples += work.samples + work.relit;
    run->seconds += bench_process_seconds() - started;
    return bench_good(&world->scene, result);
}

void ambience_run_close(ambience_run *run)
{
    alp_ambience_sampler_destroy(run->sampler);
    alp_ambience_destroy(run->ambience);
    *run = (ambience_run){0};
}
