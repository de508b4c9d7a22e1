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

#include <math.h>
#include <string.h>

enum {
    // Directions that leave from one point of a receiver with extent. They are a block of the
    // sequence and so well spread by themselves; more points would cost set-up and gain little.
    SAMPLES_PER_POINT = 16,
    POINTS_PER_CHUNK = 32,
    // Work is cut so that one range takes a few milliseconds and cancelling stays prompt.
    RAYS_PER_RANGE = 1 << 15,
    SAMPLES_PER_ROUND = 1 << 12
};

typedef struct gather_job {
    const alpi_occlusion_setup *setup;
    alpi_occlusion_kernel *kernel;
    const alpi_receivers *receivers;
    const uint32_t *list;
    uint32_t list_count, first, count;
    alpi_occlusion_sums *sums;
} gather_job;

/// The kernel for this machine, unless the context asks for less.
static alpi_occlusion_kernel *choose_kernel(alp_context *context)
{
#ifdef ALPI_HAS_V3_KERNEL
    const char *isa = alpi_context_options(context)->max_isa;
    if ((isa == NULL || strcmp(isa, "avx2") == 0) && __builtin_cpu_supports("avx2") &&
        __builtin_cpu_supports("bmi2")) {
        return alpi_occlusion_kernel_v3;
    }
#endif
    (void)context;
    return alpi_occlusion_kernel_baseline;
}

static void set_lane(alpi_occlusion_lanes *lanes, int lane, const alpi_receiver_point *p)
{
    vec3 t, b, n = p->shading_normal;
    vec3 origin = vec3_mad(p->position, p->offset, p->geometric_normal);
    vec3_frame(n, &t, &b);
    const vec3 columns[4] = {origin, t, b, n};
    float(*const targets[4])[ALPI_PACKET] = {lanes->origin, lanes->tangent, lanes->bitangent,
                                             lanes->normal};
    for (int k = 0; k < 4; k++) {
        targets[k][0][lane] = columns[k].x;
        targets[k][1][lane] = columns[k].y;
        targets[k][2][lane] = columns[k].z;
    }
}

static void set_shifts(const alpi_occlusion_setup *setup, alpi_occlusion_lanes *lanes, int lane,
                       uint64_t receiver, uint32_t replicate)
{
    uint32_t key =
        alpi_random_key(setup->options.seed, receiver, ALPI_STREAM_DIRECTION + replicate);
    lanes->shift[0][lane] = alpi_hash32(key ^ 0x68bc21ebu) & setup->shift_mask;
    lanes->shift[1][lane] = alpi_hash32(key ^ 0x02e5be93u) & setup->shift_mask;
    lanes->shift[2][lane] = alpi_hash32(key ^ 0x967a889bu);
}

/// Points [first, first + count) of one receiver's replicate.
static void place_points(const gather_job *job, uint32_t receiver, uint32_t replicate,
                         uint32_t first, uint32_t count, alpi_receiver_point *points)
{
    const alpi_receivers *r = job->receivers;
    float square[POINTS_PER_CHUNK][2];
    uint32_t key =
        alpi_random_key(job->setup->options.seed, receiver, ALPI_STREAM_PLACE + replicate);
    for (uint32_t k = 0; k < count; k++) {
        vec2 u = alpi_sample_2d(key, first + k);
        square[k][0] = u.x;
        square[k][1] = u.y;
    }
    r->place(r->user, receiver, count, (const float(*)[2])square, points);
}

/// A run of samples of one replicate, from up to POINTS_PER_CHUNK points of each lane.
static void run_chunk(const gather_job *job, const uint32_t ids[ALPI_PACKET], uint32_t replicate,
                      uint32_t first, uint32_t count, alpi_occlusion_lanes *lanes,
                      alpi_occlusion_tally *tally)
{
    alpi_receiver_point points[ALPI_PACKET][POINTS_PER_CHUNK];
    const uint32_t per_point = job->receivers->extended ? SAMPLES_PER_POINT : count;
    const uint32_t point_count = (count + per_point - 1) / per_point;
    for (int i = 0; i < ALPI_PACKET; i++) {
        place_points(job, ids[i], replicate, first / SAMPLES_PER_POINT, point_count, points[i]);
    }
    const uint32_t(*samples)[3] = (const uint32_t(*)[3])job->setup->sequence +
                                  (size_t)replicate * job->setup->samples + first;
    for (uint32_t p = 0; p < point_count; p++) {
        for (int i = 0; i < ALPI_PACKET; i++) {
            set_lane(lanes, i, &points[i][p]);
        }
        uint32_t done = p * per_point;
        uint32_t rest = count - done;
        job->kernel(job->setup, lanes, samples + done, rest < per_point ? rest : per_point, tally);
    }
}

static void run_packet(const gather_job *job, uint32_t at)
{
    alpi_occlusion_lanes lanes;
    uint32_t ids[ALPI_PACKET];
    const uint32_t used = job->list_count - at < ALPI_PACKET ? job->list_count - at : ALPI_PACKET;
    const uint32_t chunk =
        job->receivers->extended ? SAMPLES_PER_POINT * POINTS_PER_CHUNK : job->count;
    lanes.active = (1u << used) - 1u;
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        uint32_t k = i < used ? at + i : at + used - 1;
        ids[i] = job->list != NULL ? job->list[k] : k;
    }
    for (uint32_t r = 0; r < job->setup->replicates; r++) {
        alpi_occlusion_tally tally = {{0}, {{0}}};
        for (int i = 0; i < ALPI_PACKET; i++) {
            set_shifts(job->setup, &lanes, i, ids[i], r);
        }
        for (uint32_t done = 0; done < job->count; done += chunk) {
            uint32_t rest = job->count - done;
            run_chunk(job, ids, r, job->first + done, rest < chunk ? rest : chunk, &lanes, &tally);
        }
        for (uint32_t i = 0; i < used; i++) {
            job->sums->open[ids[i]][r] += tally.open[i];
            for (int k = 0; k < 3 && job->setup->bent; k++) {
                job->sums->bent[ids[i]][k] += tally.bent[k][i];
            }
        }
    }
}

static alp_result run_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    for (uint32_t packet = begin; packet < end; packet++) {
        run_packet(user, packet * ALPI_PACKET);
    }
    return ALP_OK;
}

alp_result alpi_occlusion_add(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              const uint32_t *list, uint32_t list_count, uint32_t first,
                              uint32_t count, const alpi_task_progress *progress,
                              alpi_occlusion_sums *sums)
{
    gather_job job = {.setup = setup,
                      .kernel = choose_kernel(setup->context),
                      .receivers = receivers,
                      .list = list,
                      .list_count = list_count,
                      .sums = sums};
    const uint32_t packets = list_count / ALPI_PACKET + (list_count % ALPI_PACKET != 0);
    for (uint32_t done = 0; done < count; done += SAMPLES_PER_ROUND) {
        job.first = first + done;
        job.count = count - done < SAMPLES_PER_ROUND ? count - done : SAMPLES_PER_ROUND;
        const uint32_t rays = job.count * setup->replicates * ALPI_PACKET; // of a packet
        alpi_task_progress told = progress != NULL ? *progress : (alpi_task_progress){0};
        told.units_per_item = rays;
        told.units_are_rays = true;
        told.units_before += (double)rays * packets / job.count * done;
        told.units_total +=
            told.units_total > 0.0 ? 0.0 : (double)rays * packets / job.count * count;
        const uint32_t grain = rays < RAYS_PER_RANGE ? RAYS_PER_RANGE / rays : 1;
        ALP_TRY(alpi_parallel_for(setup->context, packets, grain, run_range, &job, &told));
    }
    return ALP_OK;
}

alp_result alpi_occlusion_gather(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                                 const uint32_t *list, uint32_t list_count, float *accessibility)
{
    alpi_occlusion_sums sums = {0};
    sums.open = alpi_allocate(setup->context, receivers->count, sizeof *sums.open);
    if (sums.open == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alpi_task_progress progress = {.callback = setup->options.progress,
                                         .user = setup->options.progress_user,
                                         .stage = "occlusion"};
    alp_result result =
        alpi_occlusion_add(setup, receivers, list, list_count, 0, setup->samples, &progress, &sums);
    const double rays = (double)setup->samples * setup->replicates;
    for (uint32_t i = 0; i < list_count && result == ALP_OK; i++) {
        const uint32_t id = list != NULL ? list[i] : i;
        double open = 0.0;
        for (uint32_t r = 0; r < setup->replicates; r++) {
            open += sums.open[id][r];
        }
        accessibility[id] = (float)(open / rays);
    }
    alpi_release(setup->context, sums.open);
    return result;
}

void alpi_occlusion_of_packet(const alpi_occlusion_setup *setup,
                              const alpi_receiver_point points[ALPI_PACKET],
                              const uint64_t keys[ALPI_PACKET], uint32_t active, uint32_t count,
                              float accessibility[ALPI_PACKET])
{
    alpi_occlusion_lanes lanes = {.active = active};
    alpi_occlusion_tally tally = {{0}, {{0}}};
    alpi_occlusion_kernel *kernel = choose_kernel(setup->context);
    for (int i = 0; i < ALPI_PACKET; i++) {
        set_lane(&lanes, i, &points[i]);
    }
    for (uint32_t r = 0; r < setup->replicates; r++) {
        for (int i = 0; i < ALPI_PACKET; i++) {
            set_shifts(setup, &lanes, i, keys[i], r);
        }
        kernel(setup, &lanes, (const uint32_t(*)[3])setup->sequence + (size_t)r * setup->samples,
               count, &tally);
    }
    for (int i = 0; i < ALPI_PACKET; i++) {
        accessibility[i] = (float)((double)tally.open[i] / ((double)count * setup->replicates));
    }
}
