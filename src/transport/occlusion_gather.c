// SPDX-License-Identifier: MIT
// From receivers to packets. A packet holds one sample of eight neighbouring receivers, not eight
// samples of one: all receivers use one sequence of samples, each with a digital shift of its own
// below the leading bits, so the rays of a packet start close to each other and leave in nearly the
// same direction. Conditional on the sequence the shifts are independent, and each alone is
// unbiased: the errors of neighbours are not correlated.
// Based on: C. Kollig, A. Keller. Efficient Multidimensional Sampling. CGF 21(3), 2002.
#include "transport/occlusion_kernel.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"

#include <assert.h>
#include <string.h>

// Uses of random numbers, apart from each other (2 is the sequence's).
enum { STREAM_DIRECTION = 0, STREAM_PLACE = 1 };

enum {
    POINTS_PER_CHUNK = 33, // of 256 samples, and one that is in use already
    // Work is cut so that one range takes less than a millisecond: cancelling stays prompt, and
    // workers end together also where a list is short.
    RAYS_PER_RANGE = 1 << 13,
    SAMPLES_PER_ROUND = 1 << 14
};

typedef struct gather_job {
    const alpi_occlusion_setup *setup;
    const alpi_receivers *receivers;
    const uint32_t *list;
    uint32_t list_count;
    uint32_t first, end;      // samples
    uint32_t parted, quarter; // the quarters' first sample and length, from `parted` on
    alpi_occlusion_sums *sums;
} gather_job;

void alpi_occlusion_lanes_start(alpi_occlusion_lanes *lanes)
{
    lanes->pending = 0;
    lanes->cosine = 1.0f;
    for (int k = 0; k < ALPI_TRACE_BATCH; k++) {
        alpi_rays *rays = &lanes->rays[k];
        memset(rays->minimum, 0, sizeof rays->minimum);
        memset(rays->time, 0, sizeof rays->time);
        memset(rays->mask, 0xff, sizeof rays->mask);
        memset(rays->id, 0, sizeof rays->id);
        memset(rays->flags, 0, sizeof rays->flags);
    }
}

static void set_lane(alpi_occlusion_lanes *lanes, int lane, const alpi_receiver_point *p)
{
    const vec3 origin = vec3_mad(p->position, p->offset, p->geometric_normal);
    lanes->origin[0][lane] = origin.x;
    lanes->origin[1][lane] = origin.y;
    lanes->origin[2][lane] = origin.z;
    lanes->normal[0][lane] = p->shading_normal.x;
    lanes->normal[1][lane] = p->shading_normal.y;
    lanes->normal[2][lane] = p->shading_normal.z;
}

static void set_shifts(const alpi_occlusion_setup *setup, alpi_occlusion_lanes *lanes, int lane,
                       uint64_t receiver)
{
    const uint32_t key = alpi_random_key(setup->options.seed, receiver, STREAM_DIRECTION);
    const uint32_t turned = 1u << 31;
    lanes->shift[0][lane] = (alpi_hash32(key ^ 0x68bc21ebu) & setup->shift_mask) ^ turned;
    lanes->shift[1][lane] = (alpi_hash32(key ^ 0x02e5be93u) & setup->shift_mask) ^ turned;
    lanes->shift[2][lane] = alpi_hash32(key ^ 0x967a889bu);
}

/// Points [first, first + count) of one receiver: of the places that all share, shifted for it.
static void place_points(const gather_job *job, uint32_t receiver, uint32_t first, uint32_t count,
                         alpi_receiver_point *points)
{
    const alpi_receivers *r = job->receivers;
    const uint32_t(*places)[2] = (const uint32_t(*)[2])job->setup->places + first;
    float square[POINTS_PER_CHUNK][2];
    const uint32_t key = alpi_random_key(job->setup->options.seed, receiver, STREAM_PLACE);
    const uint32_t shift[2] = {alpi_hash32(key ^ 0x68bc21ebu), alpi_hash32(key ^ 0x02e5be93u)};
    for (uint32_t k = 0; k < count; k++) {
        square[k][0] = alpi_unit_float(places[k][0] ^ shift[0]);
        square[k][1] = alpi_unit_float(places[k][1] ^ shift[1]);
    }
    r->place(r->user, receiver, count, (const float(*)[2])square, points);
}

/// The quarter of a sample. @param end out: the first sample after it
static uint32_t find_quarter(const gather_job *job, uint32_t sample, uint32_t *end)
{
    const bool early = sample < job->parted;
    const uint32_t first = early ? 0 : job->parted;
    const uint32_t length = early ? job->parted / ALPI_QUARTERS : job->quarter;
    const uint32_t quarter = (sample - first) / length;
    *end = first + (quarter + 1) * length;
    return quarter;
}

/// The lanes' points for some samples, of more than one quarter: what a receiver's points share is
/// looked up once for them.
typedef struct placed_points {
    uint32_t block; // samples that leave from one point
    uint32_t first; // point
    alpi_receiver_point points[ALPI_PACKET][POINTS_PER_CHUNK];
} placed_points;

static void place_chunk(const gather_job *job, const uint32_t ids[ALPI_PACKET], uint32_t first,
                        uint32_t end, placed_points *placed)
{
    placed->block = job->receivers->extended ? ALPI_SAMPLES_PER_POINT : UINT32_MAX;
    placed->first = first / placed->block;
    const uint32_t count = (end - 1) / placed->block - placed->first + 1;
    for (int i = 0; i < ALPI_PACKET; i++) {
        place_points(job, ids[i], placed->first, count, placed->points[i]);
    }
}

/// Samples [first, end) from the points that were placed for them, from each its block of them.
static void run_samples(const gather_job *job, const placed_points *placed, uint32_t first,
                        uint32_t end, alpi_occlusion_lanes *lanes, alpi_occlusion_tally *tally)
{
    const uint32_t(*samples)[3] = (const uint32_t(*)[3])job->setup->sequence;
    for (uint32_t at = first; at < end;) {
        const uint32_t point = at / placed->block - placed->first;
        for (int i = 0; i < ALPI_PACKET; i++) {
            set_lane(lanes, i, &placed->points[i][point]);
        }
        const uint32_t left = placed->block - at % placed->block; // of the point's samples
        const uint32_t count = end - at < left ? end - at : left;
        job->setup->kernel(job->setup, lanes, samples + at, count, tally);
        at += count;
    }
    job->setup->kernel(job->setup, lanes, NULL, 0, tally);
}

/// Adds what the lanes that are in use met in samples of one quarter.
static void add_tally(const gather_job *job, const uint32_t ids[ALPI_PACKET], uint32_t used,
                      uint32_t quarter, const alpi_occlusion_tally *tally)
{
    for (uint32_t i = 0; i < used; i++) {
        job->sums->open[ids[i]][quarter] += tally->open[i];
        for (int k = 0; k < 3 && job->sums->vectors != NULL; k++) {
            job->sums->vectors[ids[i]][k] += tally->sum[k][i];
        }
    }
}

/// Samples [first, end) of a packet, quarter by quarter.
static void run_chunk(const gather_job *job, const uint32_t ids[ALPI_PACKET], uint32_t used,
                      uint32_t first, uint32_t end, alpi_occlusion_lanes *lanes)
{
    placed_points placed;
    place_chunk(job, ids, first, end, &placed);
    for (uint32_t at = first; at < end;) {
        uint32_t next;
        const uint32_t quarter = find_quarter(job, at, &next);
        next = next < end ? next : end;
        alpi_occlusion_tally tally = {{0}, {{0}}};
        run_samples(job, &placed, at, next, lanes, &tally);
        add_tally(job, ids, used, quarter, &tally);
        at = next;
    }
}

static void run_packet(const gather_job *job, uint32_t first_item, alpi_occlusion_lanes *lanes)
{
    uint32_t ids[ALPI_PACKET];
    const uint32_t items = job->list_count - first_item;
    const uint32_t used = items < ALPI_PACKET ? items : ALPI_PACKET;
    const uint32_t chunk = ALPI_SAMPLES_PER_POINT * (POINTS_PER_CHUNK - 1); // one may be in use
    lanes->active = (1u << used) - 1u;
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        const uint32_t k = first_item + (i < used ? i : used - 1);
        ids[i] = job->list != NULL ? job->list[k] : k;
        set_shifts(job->setup, lanes, (int)i, ids[i]);
    }
    for (uint32_t at = job->first; at < job->end;) {
        const bool whole = !job->receivers->extended || job->end - at <= chunk;
        const uint32_t end = whole ? job->end : at + chunk;
        run_chunk(job, ids, used, at, end, lanes);
        at = end;
    }
    for (uint32_t i = 0; i < used; i++) {
        job->sums->done[ids[i]] += job->end - job->first;
    }
}

static alp_result run_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    alpi_occlusion_lanes lanes;
    alpi_occlusion_lanes_start(&lanes);
    for (uint32_t packet = begin; packet < end; packet++) {
        run_packet(user, packet * ALPI_PACKET, &lanes);
    }
    return ALP_OK;
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
    gather_job job = {.setup = setup,
                      .receivers = receivers,
                      .list = list,
                      .list_count = list_count,
                      .parted = sums->parted,
                      .quarter = (total - sums->parted) / ALPI_QUARTERS,
                      .sums = sums};
    const uint32_t packets = list_count / ALPI_PACKET + (list_count % ALPI_PACKET != 0);
    alpi_task_progress told = progress != NULL ? *progress : (alpi_task_progress){0};
    const double before = told.units_before;
    told.units_are_rays = true;
    told.units_total += told.units_total > 0.0 ? 0.0 : (double)packets * ALPI_PACKET * count;
    for (uint32_t done = 0; done < count; done += SAMPLES_PER_ROUND) {
        const uint32_t samples =
            count - done < SAMPLES_PER_ROUND ? count - done : SAMPLES_PER_ROUND;
        const uint32_t rays = samples * ALPI_PACKET; // of a packet
        const uint32_t grain = rays < RAYS_PER_RANGE ? RAYS_PER_RANGE / rays : 1;
        job.first = first + done;
        job.end = job.first + samples;
        told.units_per_item = rays;
        told.units_before = before + (double)packets * ALPI_PACKET * done;
        ALP_TRY(alpi_parallel_for(setup->context, packets, grain, run_range, &job, &told));
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

void alpi_occlusion_of_packet(const alpi_occlusion_setup *setup,
                              const alpi_receiver_point points[ALPI_PACKET],
                              const uint64_t keys[ALPI_PACKET], uint32_t active,
                              float accessibility[ALPI_PACKET])
{
    alpi_occlusion_lanes lanes;
    alpi_occlusion_tally tally = {{0}, {{0}}};
    alpi_occlusion_lanes_start(&lanes);
    lanes.active = active;
    for (int i = 0; i < ALPI_PACKET; i++) {
        set_lane(&lanes, i, &points[i]);
        set_shifts(setup, &lanes, i, keys[i]);
    }
    setup->kernel(setup, &lanes, (const uint32_t(*)[3])setup->sequence, setup->samples, &tally);
    setup->kernel(setup, &lanes, NULL, 0, &tally);
    for (int i = 0; i < ALPI_PACKET; i++) {
        accessibility[i] = (float)((double)tally.open[i] / setup->samples);
    }
}
