// SPDX-License-Identifier: MIT
#include "transport/sphere/sphere_hits.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "transport/sphere/sphere_aimed.h"
#include "transport/sphere/sphere_lamps.h"
#include "transport/sphere/sphere_moments.h"
#include "transport/sphere/sphere_relight.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { STREAM_HITS = 14, BATCH = ALPI_SPHERE_BATCH, TALLIES = 3 * ALPI_SH9_COUNT, USE_DISK = 1 };

/// Sums of one point.
typedef struct hits_sums {
    alpi_sphere_tallies rays, aimed;
    double behind;
    float front, back; // nearest
    vec3 back_direction;
    alpi_sphere_moments moments;
} hits_sums;

// --- geometry ------------------------------------------------------------------------------------

static void add_geometry(const alpi_sphere_packet *p, const alpi_sphere_hit *hits, hits_sums *sums)
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        const float distance = hits[i].distance;
        if (hits[i].triangle == ALPI_NONE) {
            continue;
        }
        if ((hits[i].side & ALPI_HIT_SIDE) != ALPI_HIT_BLACK) {
            sums->front = distance < sums->front ? distance : sums->front;
            continue;
        }
        sums->behind += (double)p->weight[i];
        if (distance < sums->back) {
            sums->back = distance;
            sums->back_direction =
                (vec3){p->rays.direction_x[i], p->rays.direction_y[i], p->rays.direction_z[i]};
        }
    }
}

static void add_moments(const alpi_sphere_hits_run *run, float reach,
                        const alpi_sphere_packet *packets,
                        const alpi_sphere_hit (*hits)[ALPI_PACKET], uint32_t count,
                        alpi_sphere_moments *moments)
{
    alpi_hits met[BATCH];
    for (uint32_t k = 0; k < count; k++) {
        for (int i = 0; i < ALPI_PACKET; i++) {
            met[k].distance[i] = hits[k][i].distance;
        }
    }
    alpi_sphere_moments_add(run->loops, packets, met, count, reach, moments);
}

// --- points --------------------------------------------------------------------------------------

/// One half of a chequerboard of pixels.
static bool is_in_half(int lane, int half)
{
    return (lane % 4 + lane / 4) % 2 == half;
}

static double sum_half(const float lanes[ALPI_PACKET], int half)
{
    double sum = 0.0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        sum += is_in_half(i, half) ? (double)lanes[i] : 0.0;
    }
    return sum;
}

static void finish_light(const hits_sums *sums, alpi_sphere_light *out)
{
    const double w[2] = {sum_half(sums->rays.weight, 0), sum_half(sums->rays.weight, 1)};
    for (int i = 0; i < TALLIES; i++) {
        double rays[2], aimed[2];
        for (int half = 0; half < 2; half++) {
            rays[half] = 4.0 * ALPI_PI * sum_half(sums->rays.light[i], half);
            aimed[half] = sum_half(sums->aimed.light[i], half);
        }
        const double mean = (rays[0] + rays[1]) / (w[0] + w[1]) + aimed[0] + aimed[1];
        const double apart = rays[0] / w[0] - rays[1] / w[1] + 2.0 * (aimed[0] - aimed[1]);
        out->light.c[i / 3][i % 3] = (float)mean;
        out->variance.c[i / 3][i % 3] = (float)(0.25 * apart * apart);
    }
    out->behind = (float)(sums->behind / (w[0] + w[1]));
    out->back_distance = sums->back;
    out->front_distance = sums->front;
    vec3_store(out->back_direction, sums->back_direction);
}

static void gather_rays(const alpi_sphere_hits_work *work, const alpi_sphere_hits_point *at,
                        bool moments, hits_sums *sums)
{
    const alpi_sphere_hits_run *run = work->run;
    const uint32_t packet_count = alpi_sphere_hits_count(at->face) / ALPI_PACKET;
    alpi_sphere_hit scratch[BATCH][ALPI_PACKET];
    alpi_sphere_packet packets[BATCH];
    for (uint32_t first = 0; first < packet_count; first += BATCH) {
        const uint32_t left = packet_count - first, count = left < BATCH ? left : BATCH;
        alpi_sphere_hit(*hits)[ALPI_PACKET] = scratch;
        if (at->hits != NULL) {
            hits = (alpi_sphere_hit(*)[ALPI_PACKET])(at->hits + (size_t)first * ALPI_PACKET);
        }
        for (uint32_t k = 0; k < count; k++) {
            const alpi_sphere_place place =
                alpi_sphere_place_of(at->face, at->point, work->key, first + k);
            run->loops->aim(&place, &packets[k]);
        }
        if (at->hits == NULL || !at->traced) {
            alpi_sphere_hits_trace(work, first, count, packets, hits);
        }
        const alpi_sphere_hit(*met)[ALPI_PACKET] = (const alpi_sphere_hit(*)[ALPI_PACKET])hits;
        alpi_sphere_hits_light(work, first, count, met, packets);
        run->loops->add(packets, count, &sums->rays);
        for (uint32_t k = 0; k < count; k++) {
            add_geometry(&packets[k], met[k], sums);
        }
        if (moments) {
            add_moments(run, at->reach, packets, met, count, &sums->moments);
        }
    }
}

/// As other samplers of this folder know the scene.
static alpi_sphere_rays rays_of(const alpi_sphere_hits_run *run, uint32_t face)
{
    const alpi_sphere_relight *how = run->how;
    return (alpi_sphere_rays){
        .context = how->context,
        .from = {.scene = how->scene, .tracer = how->tracer, .filter = run->filter},
        .face = face,
        .replicates = 1,
        .aimed = how->aimed,
        .occluders = how->occluders,
        .seed = how->seed};
}

static void gather_point(const alpi_sphere_hits_run *run, alpi_sphere_hits_point *at)
{
    const alpi_sphere_relight *how = run->how;
    const alpi_sphere_rays rays = rays_of(run, at->face);
    const bool moments = at->moments != NULL && !at->traced;
    const alpi_sphere_hits_work work = {
        .run = run,
        .point = at->point,
        .key = alpi_random_key(how->seed, at->key, STREAM_HITS),
        .tracing = alpi_sphere_tracing_for(how->tracer, run->filter, at->face)};
    hits_sums sums;
    memset(&sums.rays, 0, sizeof sums.rays);
    memset(&sums.aimed, 0, sizeof sums.aimed);
    sums.behind = 0.0;
    sums.front = sums.back = INFINITY;
    sums.back_direction = (vec3){0.0f, 0.0f, 0.0f};
    if (moments) {
        memset(&sums.moments, 0, sizeof sums.moments);
    }
    gather_rays(&work, at, moments, &sums);
    if (how->aimed != NULL) {
        const alpi_sphere_aim aim = alpi_sphere_aim_for(&rays, at->point, work.key);
        alpi_sphere_aimed_light(&aim, run->loops, &sums.aimed);
    }
    finish_light(&sums, &at->value);
    if (at->direct) {
        const alpi_sphere_lamps lamps = {.rays = &rays,
                                         .lighting = how->lighting,
                                         .light = how->only_light - 1u /* 0: ALPI_NONE */};
        alpi_sphere_lamps_at(&lamps, at->point, at->key, &at->value.light);
    }
    if (moments) {
        alpi_sphere_moments_finish(&sums.moments, at->reach, at->moments);
    }
}

static alp_result gather_points(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_sphere_hits_run *run = user;
    for (uint32_t i = begin; i < end; i++) {
        gather_point(run, &run->points[i]);
        if (!alpi_loop_goes_on(run->how->context)) {
            return ALP_ERROR_CANCELLED;
        }
    }
    return ALP_OK;
}

// --- lamps ---------------------------------------------------------------------------------------

static bool set_lamp(const alpi_sphere_relight *how, uint32_t light, alpi_sphere_lamp *lamp)
{
    const alpi_light *l = alpi_lighting_light(how->lighting, light);
    const uint32_t key = alpi_random_key(how->seed, light, USE_DISK);
    const bool disk = l->size > 0.0f;
    const vec3 anywhere = {0.0f, 0.0f, 0.0f};
    alpi_light_sample s = {.density = 1.0f};
    if (!(l->intensity > 0.0f)) {
        return false;
    }
    *lamp = (alpi_sphere_lamp){.light = light, .distant = l->kind == ALP_LIGHT_DIRECTIONAL};
    if (!lamp->distant) {
        return true;
    }
    lamp->mask = disk ? ALPI_DISK_DIRECTIONS - 1 : 0;
    for (uint32_t i = 0; i <= lamp->mask; i++) {
        if (!alpi_lighting_sample_light(how->lighting, light, anywhere, alpi_sample_2d(key, i),
                                        &s)) {
            return false;
        }
        vec3_store(lamp->directions[i], s.direction);
    }
    lamp->light_each = vec3_scale(s.light, disk ? 1.0f / s.density : 1.0f);
    return true;
}

static alp_result collect_lamps(alpi_sphere_hits_run *run)
{
    const alpi_sphere_relight *how = run->how;
    const uint32_t count = alpi_lighting_light_count(how->lighting);
    ALPI_TRY_NEW(how->context, run->lamps, count);
    for (uint32_t i = 0; i < count; i++) {
        const bool counts = how->only_light == 0 || how->only_light == i + 1;
        run->lamp_count += counts && set_lamp(how, i, &run->lamps[run->lamp_count]) ? 1 : 0;
    }
    return ALP_OK;
}

alp_result alpi_sphere_hits_gather(const alpi_sphere_relight *how, alpi_sphere_hits_point *points,
                                   uint32_t count, const alpi_task_progress *progress)
{
    double rays = 0.0;
    alpi_sphere_hits_run run = {
        .how = how,
        .points = points,
        .loops = &ALPI_COMPILED_FOR(how->context, alpi_sphere_loops),
        .hits_loops = &ALPI_COMPILED_FOR(how->context, alpi_sphere_hits_loops),
        .filter = how->filter,
        .sky = how->only_light == 0 ? alpi_lighting_sky(how->lighting) : NULL};
    assert(how->only_light == 0 || how->aimed == NULL);
    run.filter.panes = alpi_tracer_has_panes(how->tracer);
    for (uint32_t i = 0; i < count; i++) {
        assert(points[i].face % 4 == 0 && points[i].face >= 4 &&
               points[i].face <= ALPI_HITS_FACE_MOST);
        assert(points[i].hits != NULL || !points[i].traced);
        rays += alpi_sphere_hits_count(points[i].face);
    }
    ALP_TRY(collect_lamps(&run));
    alpi_task_progress counted = progress != NULL ? *progress : (alpi_task_progress){0};
    counted.units_per_item = count > 0 ? rays / count : 1.0;
    counted.units_are_rays = true;
    const alp_result result =
        alpi_parallel_for(how->context, count, 1, gather_points, &run, &counted);
    alpi_release(how->context, run.lamps);
    return result;
}
