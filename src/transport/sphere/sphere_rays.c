// SPDX-License-Identifier: MIT
#include "transport/sphere/sphere_rays.h"

#include "base/random.h"
#include "base/tasks.h"
#include "base/tiles/tiles.h"
#include "transport/sphere/sphere_aimed.h"
#include "transport/sphere/sphere_moments.h"

#include <math.h>
#include <string.h>

enum { STREAM_SPHERE = 12, FACES = 6, TALLIES = 3 * ALPI_SH9_COUNT };
/// Below this many triangles, rays of one pixel block are traced faster as one bundle.
enum { COHERENT_TRIANGLES = 2048 };
/// From so many pixels along a face on, two blocks are narrow enough to be one bundle.
enum { PAIRED_FACE = 16 };
enum { BATCH = ALPI_SPHERE_BATCH };
_Static_assert((int)BATCH <= (int)ALPI_LIGHT_BATCH, "batches are those of look-ups at most");

/// Sums of one point.
typedef struct sphere_sums {
    double light[ALPI_SPHERE_REPLICATES_MOST][TALLIES];
    double weight[ALPI_SPHERE_REPLICATES_MOST];
    double aimed[ALPI_SPHERE_REPLICATES_MOST][TALLIES]; // by aimed rays: not scaled
    double behind;
    float back; // nearest
    vec3 back_direction;
    _Alignas(32) float front[ALPI_PACKET]; // nearest, lane by lane
    alpi_sphere_moments moments;
} sphere_sums;

// --- light along the rays of a batch -------------------------------------------------------------

typedef struct sphere_run {
    const alpi_sphere_job *job;
    const alpi_sphere_loops *loops;
    const alpi_sky *sky; // NULL: black
    alpi_sphere_tracing tracing;
    bool cells, emitters;
} sphere_run;

/// Lanes that meet a side that is not black.
static uint32_t sort_hits(const sphere_run *run, const alpi_hits *hits, uint32_t *backs)
{
    const alpi_gather_scene *from = &run->job->rays->from;
    const uint32_t met = run->loops->find_met(hits);
    *backs = 0;
    for (uint32_t behind = hits->behind & met; behind != 0; behind &= behind - 1) {
        const int i = __builtin_ctz(behind);
        if (!alpi_surface_is_double_sided(from->scene, hits->triangle[i])) {
            *backs |= 1u << i;
        }
    }
    return met & ~*backs;
}

static vec3 direction_of(const alpi_rays *rays, int lane)
{
    return (vec3){rays->direction_x[lane], rays->direction_y[lane], rays->direction_z[lane]};
}

static void add_emission(const alpi_gather_scene *from, const alpi_hits *hits, uint32_t met,
                         alpi_sphere_packet *p)
{
    for (; met != 0; met &= met - 1) {
        const int i = __builtin_ctz(met);
        const vec3 back = vec3_scale(direction_of(&p->rays, i), -1.0f);
        const vec3 e =
            alpi_surface_emission(from->scene, hits->triangle[i], hits->b1[i], hits->b2[i], back);
        p->light[0][i] += e.x;
        p->light[1][i] += e.y;
        p->light[2][i] += e.z;
    }
}

static void add_sky(const alpi_sky *sky, const alpi_hits *hits, alpi_sphere_packet *p)
{
    vec3 directions[ALPI_PACKET], radiances[ALPI_PACKET];
    int lanes[ALPI_PACKET];
    uint32_t count = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        if (hits->triangle[i] == ALPI_NONE) {
            directions[count] = direction_of(&p->rays, i);
            lanes[count++] = i;
        }
    }
    if (count == 0) {
        return;
    }
    alpi_sky_radiances(sky, directions, count, radiances);
    for (uint32_t k = 0; k < count; k++) {
        p->light[0][lanes[k]] += radiances[k].x;
        p->light[1][lanes[k]] += radiances[k].y;
        p->light[2][lanes[k]] += radiances[k].z;
    }
}

/// Light of surfaces whose radiance lies in cells, emission and sky.
static void light_by_cells(const sphere_run *run, uint32_t count, const alpi_hits *hits,
                           const uint32_t *met, alpi_sphere_packet *packets)
{
    const alpi_gather_scene *from = &run->job->rays->from;
    static const float black[1][4] = {{0.0f}};
    const bool find = from->light.find != NULL;
    const float(*light)[4] = find ? from->light.cells : black;
    uint32_t cells[BATCH][ALPI_PACKET];
    memset(cells, 0, count * sizeof *cells); // black, as ALPI_CELL_ESCAPED is
    if (find) {
        from->light.find(from->light.user, hits, met, count, cells);
    }
    for (uint32_t k = 0; k < count; k++) {
        alpi_sphere_packet *p = &packets[k];
        run->loops->light(light, cells[k], p);
        if (run->emitters) {
            add_emission(from, &hits[k], met[k], p);
        }
        if (run->sky != NULL) {
            add_sky(run->sky, &hits[k], p);
        }
    }
}

/// The same through panes, which needs rays of their own.
static void light_through_panes(const sphere_run *run, uint32_t count, alpi_sphere_packet *packets)
{
    for (uint32_t k = 0; k < count; k++) {
        alpi_rays rays = packets[k].rays; // panes move where they start
        vec3 radiance[ALPI_PACKET];
        alpi_gather_trace(&run->job->rays->from, &rays, 0xffu, run->tracing.coherent, radiance,
                          NULL);
        for (int i = 0; i < ALPI_PACKET; i++) {
            packets[k].light[0][i] = radiance[i].x;
            packets[k].light[1][i] = radiance[i].y;
            packets[k].light[2][i] = radiance[i].z;
        }
    }
}

// --- sums ----------------------------------------------------------------------------------------

static void add_geometry(const alpi_sphere_packet *p, const alpi_hits *hits, uint32_t met,
                         uint32_t backs, sphere_sums *sums)
{
    for (; met != 0; met &= met - 1) {
        const int i = __builtin_ctz(met);
        sums->front[i] = fminf(sums->front[i], hits->distance[i]);
    }
    for (; backs != 0; backs &= backs - 1) {
        const int i = __builtin_ctz(backs);
        sums->behind += (double)p->weight[i];
        if (hits->distance[i] < sums->back) {
            sums->back = hits->distance[i];
            sums->back_direction = direction_of(&p->rays, i);
        }
    }
}

alpi_sphere_tracing alpi_sphere_tracing_for(const alpi_tracer *tracer, alpi_trace_filter filter,
                                            uint32_t face_side)
{
    return (alpi_sphere_tracing){.tracer = tracer,
                                 .filter = filter,
                                 .coherent =
                                     alpi_tracer_triangle_count(tracer) < COHERENT_TRIANGLES,
                                 .in_pairs = face_side >= PAIRED_FACE};
}

void alpi_sphere_trace(const alpi_sphere_tracing *t, uint32_t count,
                       const alpi_sphere_packet *packets, alpi_hits *hits)
{
    const alpi_rays *rays[BATCH];
    uint32_t active[BATCH];
    for (uint32_t k = 0; k < count; k++) {
        rays[k] = &packets[k].rays;
        active[k] = 0xffu;
        if (!t->coherent) {
            alpi_trace_nearest(t->tracer, rays[k], 0xffu, t->filter, &hits[k]);
        } else if (!t->in_pairs) {
            alpi_trace_nearest_coherent(t->tracer, rays[k], 0xffu, t->filter, &hits[k]);
        }
    }
    if (t->coherent && t->in_pairs) {
        alpi_trace_nearest_coherent_many(t->tracer, rays, active, count, t->filter, hits);
    }
}

static void gather_batch(const sphere_run *run, uint32_t count, alpi_sphere_packet *packets,
                         sphere_sums *sums)
{
    const alpi_sphere_rays *r = run->job->rays;
    alpi_hits hits[BATCH];
    uint32_t met[BATCH], backs[BATCH];
    alpi_sphere_trace(&run->tracing, count, packets, hits);
    for (uint32_t k = 0; k < count; k++) {
        met[k] = sort_hits(run, &hits[k], &backs[k]);
    }
    if (run->cells) {
        light_by_cells(run, count, hits, met, packets);
    } else {
        light_through_panes(run, count, packets);
    }
    for (uint32_t k = 0; k < count; k++) {
        if (backs[k] == 0) {
            run->loops->find_nearest(&hits[k], sums->front);
        } else {
            add_geometry(&packets[k], &hits[k], met[k], backs[k], sums);
        }
    }
    if (run->job->moments != NULL) {
        alpi_sphere_moments_add(run->loops, packets, hits, count, r->reach, &sums->moments);
    }
}

static double sum_lanes(const float lanes[ALPI_PACKET])
{
    double sum = 0.0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        sum += (double)lanes[i];
    }
    return sum;
}

static void sum_light(const alpi_sphere_tallies *tallies, double light[TALLIES])
{
    for (int i = 0; i < TALLIES; i++) {
        light[i] = sum_lanes(tallies->light[i]);
    }
}

static void gather_replicate(const sphere_run *run, uint32_t point, uint32_t replicate,
                             sphere_sums *sums)
{
    const alpi_sphere_rays *r = run->job->rays;
    const vec3 position = vec3_load(run->job->points[point]);
    const uint32_t key =
        alpi_hash32(alpi_random_key(r->seed, point, STREAM_SPHERE) ^ alpi_hash32(replicate + 1u));
    const uint32_t packet_count = FACES * r->face * r->face / ALPI_PACKET;
    alpi_sphere_packet packets[BATCH];
    alpi_sphere_tallies tallies;
    memset(&tallies, 0, sizeof tallies);
    for (uint32_t first = 0; first < packet_count; first += BATCH) {
        const uint32_t left = packet_count - first;
        const uint32_t count = left < BATCH ? left : BATCH;
        for (uint32_t k = 0; k < count; k++) {
            const alpi_sphere_place place = alpi_sphere_place_of(r->face, position, key, first + k);
            run->loops->aim(&place, &packets[k]);
        }
        gather_batch(run, count, packets, sums);
        run->loops->add(packets, count, &tallies);
    }
    sum_light(&tallies, sums->light[replicate]);
    sums->weight[replicate] = sum_lanes(tallies.weight);
    memset(&tallies, 0, sizeof tallies);
    if (r->aimed != NULL) {
        const alpi_sphere_aim aim = alpi_sphere_aim_for(r, position, key);
        alpi_sphere_aimed_light(&aim, run->loops, &tallies);
    }
    sum_light(&tallies, sums->aimed[replicate]);
}

/// Coefficient i of a replicate.
static double replicate_mean(const sphere_sums *sums, uint32_t replicate, int i)
{
    return 4.0 * ALPI_PI * sums->light[replicate][i] / sums->weight[replicate] +
           sums->aimed[replicate][i];
}

static void finish_light(const alpi_sphere_rays *r, const sphere_sums *sums, alpi_sphere_light *out)
{
    const double count = r->replicates;
    double weight = 0.0;
    for (int i = 0; i < TALLIES; i++) {
        double mean = 0.0, squares = 0.0;
        for (uint32_t k = 0; k < r->replicates; k++) {
            mean += replicate_mean(sums, k, i) / count;
        }
        for (uint32_t k = 0; k < r->replicates; k++) {
            const double apart = replicate_mean(sums, k, i) - mean;
            squares += apart * apart;
        }
        out->light.c[i / 3][i % 3] = (float)mean;
        out->variance.c[i / 3][i % 3] = (float)(squares / (count * (count - 1.0)));
    }
    for (uint32_t k = 0; k < r->replicates; k++) {
        weight += sums->weight[k];
    }
    out->behind = (float)(sums->behind / weight);
    out->back_distance = sums->back;
    out->front_distance = INFINITY;
    for (int i = 0; i < ALPI_PACKET; i++) {
        out->front_distance = fminf(out->front_distance, sums->front[i]);
    }
    vec3_store(out->back_direction, sums->back_direction);
}

static alp_result gather_points(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const sphere_run *run = user;
    const alpi_sphere_job *job = run->job;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t point = job->list != NULL ? job->list[i] : i;
        sphere_sums sums;
        sums.behind = 0.0;
        sums.back = INFINITY;
        sums.back_direction = (vec3){0.0f, 0.0f, 0.0f};
        memset(&sums.moments, 0, sizeof sums.moments);
        for (int lane = 0; lane < ALPI_PACKET; lane++) {
            sums.front[lane] = INFINITY;
        }
        for (uint32_t k = 0; k < job->rays->replicates; k++) {
            gather_replicate(run, point, k, &sums);
        }
        finish_light(job->rays, &sums, &job->values[point]);
        if (job->moments != NULL) {
            alpi_sphere_moments_finish(&sums.moments, job->rays->reach,
                                       job->moments + (size_t)point * ALPI_SPHERE_MOMENTS);
        }
        if (!alpi_loop_goes_on(job->rays->context)) {
            return ALP_ERROR_CANCELLED;
        }
    }
    return ALP_OK;
}

alp_result alpi_sphere_gather(const alpi_sphere_job *job, const alpi_task_progress *progress)
{
    const alpi_sphere_rays *r = job->rays;
    const alpi_gather_scene *from = &r->from;
    sphere_run run = {
        .job = job,
        .loops = &ALPI_COMPILED_FOR(r->context, alpi_sphere_loops),
        .cells = !alpi_tracer_has_panes(from->tracer) &&
                 (from->light.find != NULL || from->light.reflected == NULL),
        .emitters = from->emitters && from->lighting != NULL &&
                    alpi_lighting_emitter_count(from->lighting) > 0,
        .sky = from->sky && from->lighting != NULL ? alpi_lighting_sky(from->lighting) : NULL,
        .tracing = alpi_sphere_tracing_for(from->tracer, from->filter, r->face),
    };
    alpi_task_progress counted = progress != NULL ? *progress : (alpi_task_progress){0};
    counted.units_per_item = (double)alpi_sphere_rays_count(r);
    counted.units_are_rays = true;
    const alpi_tile_output outputs[] = {
        {.data = job->values, .size = sizeof *job->values, .list = job->list, .count = job->count},
        {.data = job->moments,
         .size = ALPI_SPHERE_MOMENTS * sizeof *job->moments,
         .list = job->list,
         .count = job->count}};
    return alpi_tile_loop_run(r->context, &(alpi_tile_loop){.name = "sphere",
                                                            .count = job->count,
                                                            .grain = 1,
                                                            .body = gather_points,
                                                            .user = &run,
                                                            .progress = &counted,
                                                            .outputs = outputs,
                                                            .output_count = 2});
}
