// SPDX-License-Identifier: MIT
// From receivers to packets. All receivers use one sequence of samples, in packets of eight that
// leave in nearly the same direction (occlusion_run.h), each with a digital shift of its own, which
// takes packets to others: the errors of neighbours are independent but for the sequence.
// Based on: C. Kollig, A. Keller. Efficient Multidimensional Sampling. CGF 21(3), 2002.
#include "transport/occlusion/occlusion_kernel.h"

#include "base/hash.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/tiles/tiles.h"

#include <assert.h>
#include <string.h>

// Uses of random numbers, apart from each other (2 is the sequence's).
enum { STREAM_DIRECTION = 0, STREAM_PLACE = 1 };

enum {
    // Work is cut so that one range takes a millisecond or a few: cancelling stays prompt, and
    // workers end together also where a list is short.
    RAYS_PER_RANGE = 1 << 14,
    SAMPLES_PER_ROUND = 1 << 14,
    PACKETS_TOGETHER = 2 * ALPI_TRACE_BATCH
};

typedef struct gather_job {
    const alpi_occlusion_setup *setup;
    const alpi_receivers *receivers;
    const uint32_t *list;
    alpi_sample_run run;
    uint32_t first, samples; // of the run
    alpi_occlusion_sums *sums;
} gather_job;

/// What no kernel sets: of a packet, or of a pair.
#define START_RAYS(rays)                                                                           \
    do {                                                                                           \
        memset((rays)->minimum, 0, sizeof(rays)->minimum);                                         \
        memset((rays)->time, 0, sizeof(rays)->time);                                               \
        memset((rays)->mask, 0xff, sizeof(rays)->mask);                                            \
        memset((rays)->id, 0, sizeof(rays)->id);                                                   \
        memset((rays)->flags, 0, sizeof(rays)->flags);                                             \
    } while (0)

void alpi_occlusion_stand_start(const alpi_occlusion_setup *setup, alpi_occlusion_stand *stand)
{
    const bool pairs = alpi_tracer_takes_pairs(setup->tracer);
    for (uint32_t k = 0; k < ALPI_TRACE_BATCH / 2 && pairs; k++) {
        START_RAYS(&stand->pairs[k]);
    }
    for (uint32_t k = 0; k < ALPI_TRACE_BATCH; k++) {
        START_RAYS(&stand->rays[k]);
    }
}

static void set_shifts(const alpi_occlusion_setup *setup, uint64_t receiver, uint32_t shift[3])
{
    const uint32_t key = alpi_random_key(setup->options.seed, receiver, STREAM_DIRECTION);
    const uint32_t turned = 1u << 31;
    shift[0] = alpi_hash32(key ^ 0x68bc21ebu) ^ turned;
    shift[1] = alpi_hash32(key ^ 0x02e5be93u) ^ turned;
    shift[2] = alpi_hash32(key ^ 0x967a889bu);
}

static void set_lane(alpi_occlusion_lanes *lanes, uint32_t lane, const alpi_receiver_point *p)
{
    const vec3 origin = vec3_mad(p->position, p->offset, p->geometric_normal);
    lanes->origin[0][lane] = origin.x;
    lanes->origin[1][lane] = origin.y;
    lanes->origin[2][lane] = origin.z;
    lanes->normal[0][lane] = p->shading_normal.x;
    lanes->normal[1][lane] = p->shading_normal.y;
    lanes->normal[2][lane] = p->shading_normal.z;
}

/// Puts a receiver's points for a chunk into its groups: of the places that all share, shifted for
/// it.
static void place_points(const gather_job *job, uint32_t receiver, const alpi_sample_chunk *chunk,
                         alpi_occlusion_lanes *groups)
{
    const alpi_receivers *r = job->receivers;
    const uint32_t(*places)[2] = (const uint32_t(*)[2])job->setup->places + chunk->first_place;
    const uint32_t key = alpi_random_key(job->setup->options.seed, receiver, STREAM_PLACE);
    const uint32_t shift[2] = {alpi_hash32(key ^ 0x68bc21ebu), alpi_hash32(key ^ 0x02e5be93u)};
    float square[ALPI_CHUNK_PLACES][2];
    alpi_receiver_point points[ALPI_CHUNK_PLACES];
    for (uint32_t k = 0; k < chunk->place_count; k++) {
        square[k][0] = alpi_unit_float(places[k][0] ^ shift[0]);
        square[k][1] = alpi_unit_float(places[k][1] ^ shift[1]);
    }
    r->place(r->user, receiver, chunk->place_count, (const float(*)[2])square, points);
    for (uint32_t g = 0; g < chunk->groups; g++) {
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            set_lane(&groups[g], i, &points[chunk->place[g][i]]);
        }
    }
}

/// Receivers whose packets of a chunk go together: their points are placed one after the other,
/// which is faster than each between the rays of others.
static uint32_t receivers_of(const alpi_sample_chunk *chunk)
{
    const uint32_t fit = ALPI_CHUNK_GROUPS / chunk->groups;
    const uint32_t wanted = PACKETS_TOGETHER / chunk->packet_count;
    const uint32_t most = fit < ALPI_PACKET ? fit : ALPI_PACKET;
    const bool whole = chunk->last == (1u << ALPI_PACKET) - 1u;
    return !whole || wanted < 1 ? 1 : wanted < most ? wanted : most;
}

/// A chunk's packets of receivers [begin, end) of the list.
static void run_chunk(const gather_job *job, const alpi_sample_chunk *chunk, uint32_t begin,
                      uint32_t end, alpi_occlusion_stand *stand)
{
    alpi_occlusion_sums *sums = job->sums;
    const uint32_t together = receivers_of(chunk);
    for (uint32_t at = begin; at < end; at += stand->receivers) {
        alpi_occlusion_tally tallies[ALPI_PACKET] = {0};
        uint32_t ids[ALPI_PACKET] = {0};
        stand->receivers = end - at < together ? end - at : together;
        for (uint32_t r = 0; r < stand->receivers; r++) {
            ids[r] = job->list != NULL ? job->list[at + r] : at + r;
            set_shifts(job->setup, ids[r], stand->shifts[r]);
            place_points(job, ids[r], chunk, stand->groups + r * (size_t)chunk->groups);
        }
        job->setup->kernel(job->setup, &job->run, chunk, stand, tallies);
        for (uint32_t r = 0; r < stand->receivers; r++) {
            for (uint32_t i = 0; i < ALPI_PACKET; i++) {
                sums->open[ids[r]][chunk->quarter[i]] += tallies[r].open[i];
                for (int k = 0; k < 3 && sums->vectors != NULL; k++) {
                    sums->vectors[ids[r]][k] += tallies[r].sum[k][i];
                }
            }
        }
    }
}

static alp_result run_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const gather_job *job = user;
    alpi_occlusion_stand stand;
    alpi_occlusion_stand_start(job->setup, &stand);
    for (uint32_t c = 0; c < job->run.chunk_count; c++) {
        run_chunk(job, &job->run.chunks[c], begin, end, &stand);
    }
    for (uint32_t i = begin; i < end; i++) {
        job->sums->done[job->list != NULL ? job->list[i] : i] += job->samples;
    }
    return ALP_OK;
}

static alp_result run_samples(gather_job *job, uint32_t count, uint32_t grain,
                              const alpi_task_progress *progress)
{
    const alpi_occlusion_sums *s = job->sums;
    const alpi_tile_output outputs[] = {
        {.data = s->open, .size = sizeof *s->open, .list = job->list, .count = count},
        {.data = s->done, .size = sizeof *s->done, .list = job->list, .count = count},
        {.data = s->vectors, .size = sizeof *s->vectors, .list = job->list, .count = count}};
    const uint64_t parts[] = {job->setup->options.seed, job->first, job->samples};
    const uint64_t key = alpi_hash_bytes(ALPI_HASH_START, parts, sizeof parts);
    return alpi_tile_loop_run(job->setup->context, &(alpi_tile_loop){.name = "occlusion",
                                                                     .key = key,
                                                                     .count = count,
                                                                     .grain = grain,
                                                                     .body = run_range,
                                                                     .user = job,
                                                                     .progress = progress,
                                                                     .outputs = outputs,
                                                                     .output_count = 3});
}

// Nine arguments, internal: a struct of three numbers would say no more.
// NOLINTNEXTLINE(readability-function-size)
alp_result alpi_occlusion_add(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              const uint32_t *list, uint32_t list_count, uint32_t first,
                              uint32_t count, uint32_t total, const alpi_task_progress *progress,
                              alpi_occlusion_sums *sums)
{
    assert(first + count <= setup->samples && total % ALPI_QUARTERS == 0);
    assert(total > sums->parted && sums->parted % ALPI_QUARTERS == 0);
    gather_job job = {.setup = setup, .receivers = receivers, .list = list, .sums = sums};
    alpi_task_progress told = progress != NULL ? *progress : (alpi_task_progress){0};
    const double before = told.units_before;
    told.units_are_rays = true;
    told.units_total += told.units_total > 0.0 ? 0.0 : (double)list_count * count;
    for (uint32_t done = 0; done < count; done += job.samples) {
        job.samples = count - done < SAMPLES_PER_ROUND ? count - done : SAMPLES_PER_ROUND;
        told.units_per_item = job.samples;
        told.units_before = before + (double)list_count * done;
        const alpi_sample_range range = {first + done, job.samples, sums->parted, total};
        job.first = range.first;
        ALP_TRY(alpi_sample_run_create(setup, receivers->extended, &range, &job.run));
        const uint32_t grain = job.samples < RAYS_PER_RANGE ? RAYS_PER_RANGE / job.samples : 1;
        const alp_result result = run_samples(&job, list_count, grain, &told);
        alpi_sample_run_destroy(&job.run);
        ALP_TRY(result);
    }
    return ALP_OK;
}

alp_result alpi_occlusion_sums_create(alp_context *context, uint32_t receivers, bool vectors,
                                      alpi_occlusion_sums *sums)
{
    *sums = (alpi_occlusion_sums){0};
    sums->open = alpi_allocate(context, receivers, sizeof *sums->open);
    sums->done = ALPI_NEW(context, uint32_t, receivers);
    sums->vectors = vectors ? alpi_allocate(context, receivers, sizeof *sums->vectors) : NULL;
    if (sums->open == NULL || sums->done == NULL || (vectors && sums->vectors == NULL)) {
        alpi_occlusion_sums_destroy(context, sums);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    return ALP_OK;
}

void alpi_occlusion_sums_destroy(alp_context *context, alpi_occlusion_sums *sums)
{
    alpi_release(context, sums->open);
    alpi_release(context, sums->done);
    alpi_release(context, sums->vectors);
    *sums = (alpi_occlusion_sums){0};
}

void alpi_occlusion_requarter(alpi_occlusion_sums *sums, uint32_t receiver, uint32_t before,
                              uint32_t after)
{
    assert(before > 0 && after % before == 0);
    uint32_t merged[ALPI_QUARTERS] = {0};
    for (uint32_t q = 0; q < ALPI_QUARTERS; q++) {
        merged[q / (after / before)] += sums->open[receiver][q];
    }
    memcpy(sums->open[receiver], merged, sizeof merged);
}

float alpi_occlusion_value(const alpi_occlusion_sums *sums, uint32_t receiver)
{
    const uint32_t *open = sums->open[receiver];
    const double free_rays = (double)open[0] + (double)open[1] + (double)open[2] + (double)open[3];
    return sums->done[receiver] > 0 ? (float)(free_rays / (double)sums->done[receiver]) : 1.0f;
}

vec3 alpi_occlusion_mean_vector(const alpi_occlusion_sums *sums, uint32_t receiver)
{
    const uint32_t done = sums->done[receiver];
    return vec3_scale(vec3_load(sums->vectors[receiver]), done > 0 ? 1.0f / (float)done : 0.0f);
}

alp_result alpi_occlusion_gather(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                                 const uint32_t *list, uint32_t list_count, float *accessibility)
{
    alpi_occlusion_sums sums;
    ALP_TRY(alpi_occlusion_sums_create(setup->context, receivers->count, false, &sums));
    const alpi_task_progress progress = {.callback = setup->options.progress,
                                         .user = setup->options.progress_user,
                                         .stage = "occlusion"};
    alp_result result = alpi_occlusion_add(setup, receivers, list, list_count, 0, setup->samples,
                                           setup->samples, &progress, &sums);
    for (uint32_t i = 0; i < list_count && result == ALP_OK; i++) {
        const uint32_t id = list != NULL ? list[i] : i;
        accessibility[id] = alpi_occlusion_value(&sums, id);
    }
    alpi_occlusion_sums_destroy(setup->context, &sums);
    return result;
}

void alpi_occlusion_of_points(const alpi_occlusion_setup *setup, const alpi_sample_run *run,
                              const alpi_receiver_point *points, const uint64_t *keys,
                              uint32_t count, float *accessibility)
{
    alpi_occlusion_stand stand;
    alpi_occlusion_stand_start(setup, &stand);
    stand.receivers = 1;
    for (uint32_t p = 0; p < count; p++) {
        uint32_t open = 0;
        set_shifts(setup, keys[p], stand.shifts[0]);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            set_lane(&stand.groups[0], i, &points[p]);
        }
        for (uint32_t c = 0; c < run->chunk_count; c++) {
            alpi_occlusion_tally tally = {{0}, {{0}}};
            setup->kernel(setup, run, &run->chunks[c], &stand, &tally);
            for (int i = 0; i < ALPI_PACKET; i++) {
                open += tally.open[i];
            }
        }
        accessibility[p] = (float)((double)open / setup->samples);
    }
}
