// SPDX-License-Identifier: MIT
#include "transport/paths/reference.h"

#include "base/hash.h"
#include "base/random.h"
#include "base/tiles/tiles.h"
#include "transport/paths/paths.h"

#include <math.h>
#include <string.h>

enum { STREAM_PATH = 5, PATHS_PER_CHUNK = 4096 /* a few milliseconds */ };

// --- means ---------------------------------------------------------------------------------------

typedef struct replicate_sums {
    double light[ALPI_REFERENCE_REPLICATES][3];
    double covered;
} replicate_sums;

/// How many paths each replicate has.
static uint32_t samples_each(const alpi_reference *r)
{
    const uint32_t n = r->samples / ALPI_REFERENCE_REPLICATES;
    return n + (n * ALPI_REFERENCE_REPLICATES < r->samples || n == 0 ? 1 : 0);
}

uint32_t alpi_reference_samples(const alpi_reference *reference)
{
    return samples_each(reference) * ALPI_REFERENCE_REPLICATES;
}

static void add_path(const alpi_path_wave *wave, uint32_t slot, uint32_t sample,
                     replicate_sums *sums)
{
    double *sum = sums->light[sample % ALPI_REFERENCE_REPLICATES];
    const vec3 light = alpi_paths_light(wave, slot);
    sum[0] += (double)light.x;
    sum[1] += (double)light.y;
    sum[2] += (double)light.z;
    sums->covered += (double)wave->covered[slot];
}

void alpi_reference_mean(const double (*sums)[3], uint32_t replicates, uint32_t each,
                         alpi_reference_value *value)
{
    const double one = 1.0 / each, all = one / replicates;
    const double pairs = 1.0 / (replicates * (replicates - 1.0));
    double sum[3] = {0.0}, squares[3] = {0.0};
    for (uint32_t r = 0; r < replicates; r++) { // the channels side by side: sums wait for no sum
        for (int k = 0; k < 3; k++) {
            sum[k] += sums[r][k];
        }
    }
    for (uint32_t r = 0; r < replicates; r++) {
        for (int k = 0; k < 3; k++) {
            const double apart = sums[r][k] * one - sum[k] * all;
            squares[k] += apart * apart;
        }
    }
    for (int k = 0; k < 3; k++) {
        value->mean[k] = (float)(sum[k] * all);
        value->variance[k] = (float)(squares[k] * pairs);
    }
}

static void finish(const replicate_sums *sums, uint32_t each, alpi_reference_value *value)
{
    alpi_reference_mean((const double(*)[3])sums->light, ALPI_REFERENCE_REPLICATES, each, value);
}

/// Panes are this room's to see to. A tail may come through one of them from one receiver and past
/// it from another: then nothing is shared.
static alpi_reference with_panes(const alpi_reference *reference)
{
    alpi_reference own = *reference;
    own.filter.panes = alpi_tracer_has_panes(reference->tracer);
    own.share = reference->share && !own.filter.panes;
    return own;
}

// --- waves ---------------------------------------------------------------------------------------

/// A run of items (receivers or pixels), each with as many paths. Waves go on from one item to the
/// next, so that they are full whatever the number of paths.
typedef struct path_run {
    const alpi_reference *reference;
    uint32_t begin, end; // items
    uint32_t samples;    // of each
    uint32_t lanes;      // so many items share what their paths find
    int depth;           // −1: from the eye
    float first;         // throughput of a fresh path
    uint64_t (*key)(const struct path_run *run, uint32_t item);
    /// Places or aims the slots whose items and samples are listed, by their u and v.
    void (*place)(const struct path_run *run, alpi_path_wave *wave, const uint32_t *items);
    void (*take)(const struct path_run *run, uint32_t item, const replicate_sums *sums);
    void *user;
} path_run;

/// Where a run is: sample `sample` of the items of one block comes next.
typedef struct run_cursor {
    uint32_t block, lanes; // items [block, block + lanes)
    uint32_t sample;
    uint32_t keys[ALPI_PACKET]; // of their random numbers
} run_cursor;

static void open_block(const path_run *run, uint32_t block, run_cursor *cursor)
{
    const uint32_t left = run->end - block;
    *cursor = (run_cursor){.block = block, .lanes = left < run->lanes ? left : run->lanes};
    for (uint32_t i = 0; i < cursor->lanes; i++) {
        cursor->keys[i] =
            alpi_random_key(run->reference->seed, run->key(run, block + i), STREAM_PATH);
    }
}

/// A fresh path; the replicates take turns.
static void start_path(const path_run *run, const run_cursor *at, uint32_t lane, uint32_t slot,
                       alpi_path_wave *w)
{
    const uint32_t replicate = at->sample % ALPI_REFERENCE_REPLICATES;
    w->key[slot] = alpi_hash32(at->keys[lane] ^ alpi_hash32(replicate + 1u));
    w->sample[slot] = at->sample / ALPI_REFERENCE_REPLICATES;
    w->event[slot] = 0;
    w->depth[slot] = run->depth;
    w->slot[slot] = slot;
    w->block[slot] = slot - lane;
    w->lanes[slot] = at->lanes;
    w->throughput.x[slot] = w->throughput.y[slot] = w->throughput.z[slot] = run->first;
}

/// Fills a wave; a sample of a block is never parted. @param items, samples out: of each slot
static void fill_wave(const path_run *run, run_cursor *at, alpi_path_wave *w, uint32_t *items,
                      uint32_t *samples)
{
    w->count = 0;
    while (at->lanes > 0 && w->count + at->lanes <= ALPI_WAVE) {
        for (uint32_t lane = 0; lane < at->lanes; lane++) {
            items[w->count + lane] = at->block + lane;
            samples[w->count + lane] = at->sample;
            start_path(run, at, lane, w->count + lane, w);
        }
        w->count += at->lanes;
        if (++at->sample == run->samples) {
            open_block(run, at->block + at->lanes, at);
        }
    }
}

static alp_result run_paths(const path_run *run)
{
    alpi_path_wave wave;
    uint32_t items[ALPI_WAVE] = {0}, samples[ALPI_WAVE] = {0};
    replicate_sums sums[ALPI_PACKET] = {{{{0}}, 0.0}};
    run_cursor cursor;
    open_block(run, run->begin, &cursor);
    while (cursor.lanes > 0) {
        fill_wave(run, &cursor, &wave, items, samples);
        const uint32_t count = wave.count;
        alpi_paths_draw_places(run->reference, &wave);
        run->place(run, &wave, items);
        alpi_paths_run(run->reference, &wave);
        for (uint32_t i = 0; i < count; i++) {
            replicate_sums *sum = &sums[(items[i] - run->begin) % run->lanes];
            add_path(&wave, i, samples[i], sum);
            if (samples[i] + 1 == run->samples) {
                run->take(run, items[i], sum);
                memset(sum, 0, sizeof *sum);
            }
        }
        if (!alpi_loop_goes_on(run->reference->context)) {
            return ALP_ERROR_CANCELLED;
        }
    }
    return ALP_OK;
}

// --- receivers -----------------------------------------------------------------------------------

typedef struct irradiance_job {
    const alpi_reference *reference;
    const alpi_receivers *receivers;
    const uint32_t *list;
    uint32_t count;        // of the list
    uint32_t lanes, chunk; // receivers that share, and that are one item of the loop
    alpi_reference_value *values;
} irradiance_job;

static uint32_t receiver_of(const irradiance_job *job, uint32_t item)
{
    return job->list != NULL ? job->list[item] : item;
}

static uint64_t receiver_key(const path_run *run, uint32_t item)
{
    return receiver_of(run->user, item);
}

static void place_receivers(const path_run *run, alpi_path_wave *w, const uint32_t *items)
{
    const irradiance_job *job = run->user;
    for (uint32_t i = 0; i < w->count; i++) {
        const float square[1][2] = {{w->u[i], w->v[i]}};
        alpi_receiver_point point;
        job->receivers->place(job->receivers->user, receiver_of(job, items[i]), 1, square, &point);
        alpi_paths_place(w, i, &point);
    }
}

static void take_receiver(const path_run *run, uint32_t item, const replicate_sums *sums)
{
    const irradiance_job *job = run->user;
    finish(sums, samples_each(job->reference), &job->values[receiver_of(job, item)]);
}

/// Chunks [begin, end). What is in a wave, and who shares with whom, must not hang on how the loop
/// is cut: each chunk is a run of its own.
static alp_result gather_chunks(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const irradiance_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint64_t first = (uint64_t)i * job->chunk, last = first + job->chunk;
        ALP_TRY(run_paths(&(path_run){.reference = job->reference,
                                      .begin = (uint32_t)first,
                                      .end = last < job->count ? (uint32_t)last : job->count,
                                      .samples = alpi_reference_samples(job->reference),
                                      .lanes = job->lanes,
                                      .first = 1.0f,
                                      .key = receiver_key,
                                      .place = place_receivers,
                                      .take = take_receiver,
                                      .user = user}));
    }
    return ALP_OK;
}

alp_result alpi_reference_irradiance(const alpi_reference *reference,
                                     const alpi_receivers *receivers, const uint32_t *list,
                                     uint32_t list_count, const alpi_task_progress *progress,
                                     alpi_reference_value *values)
{
    const alpi_reference own = with_panes(reference);
    irradiance_job job = {.reference = &own,
                          .receivers = receivers,
                          .list = list,
                          .count = list != NULL ? list_count : receivers->count,
                          .lanes = own.share ? ALPI_PACKET : 1,
                          .values = values};
    const uint32_t samples = alpi_reference_samples(&own), each = samples * job.lanes;
    job.chunk = (each < PATHS_PER_CHUNK ? PATHS_PER_CHUNK / each : 1) * job.lanes;
    alpi_task_progress told = progress != NULL ? *progress : (alpi_task_progress){0};
    told.units_per_item = (double)samples * job.chunk;
    const alpi_tile_output output = {.data = values,
                                     .size = sizeof *values,
                                     .list = list,
                                     .count = job.count,
                                     .each = job.chunk};
    const uint64_t parts[] = {own.seed, samples, own.bounces, own.next_event};
    const uint64_t key = alpi_hash_bytes(ALPI_HASH_START, parts, sizeof parts);
    return alpi_tile_loop_run(own.context, &(alpi_tile_loop){.name = "paths",
                                                             .key = key,
                                                             .count = job.count / job.chunk +
                                                                      (job.count % job.chunk != 0),
                                                             .grain = 1,
                                                             .body = gather_chunks,
                                                             .user = &job,
                                                             .progress = &told,
                                                             .outputs = &output,
                                                             .output_count = 1});
}

// --- pictures ------------------------------------------------------------------------------------

typedef struct pixel_job {
    alpi_camera_fn *camera;
    const void *camera_user;
    uint64_t first;
    alpi_reference_value *values;
    float *covered;
} pixel_job;

static uint64_t pixel_key(const path_run *run, uint32_t item)
{
    const pixel_job *job = run->user;
    return job->first + item;
}

static void aim_pixels(const path_run *run, alpi_path_wave *w, const uint32_t *items)
{
    const pixel_job *job = run->user;
    uint64_t pixels[ALPI_WAVE];
    for (uint32_t i = 0; i < w->count; i++) {
        pixels[i] = job->first + items[i];
        w->density[i] = -1.0f; // nobody asked for light
    }
    const alpi_camera_rays rays = {{w->start.x, w->start.y, w->start.z},
                                   {w->direction.x, w->direction.y, w->direction.z}};
    job->camera(job->camera_user, w->count, pixels, w->u, w->v, &rays);
}

static void take_pixel(const path_run *run, uint32_t item, const replicate_sums *sums)
{
    const pixel_job *job = run->user;
    finish(sums, samples_each(run->reference), &job->values[item]);
    const double covered = sums->covered / run->samples;
    job->covered[item] = (float)fmin(fmax(covered, 0.0), 1.0);
}

alp_result alpi_reference_pixels(const alpi_reference *reference, alpi_camera_fn *camera,
                                 const void *camera_user, uint64_t first, uint32_t count,
                                 alpi_reference_value *values, float *covered)
{
    const alpi_reference own = with_panes(reference);
    pixel_job job = {camera, camera_user, first, values, covered};
    // L = Le + ρ/π · E, and what is met counts π.
    return run_paths(&(path_run){.reference = &own,
                                 .end = count,
                                 .samples = alpi_reference_samples(reference),
                                 .lanes = 1,
                                 .depth = -1,
                                 .first = (float)(1.0 / ALPI_PI),
                                 .key = pixel_key,
                                 .place = aim_pixels,
                                 .take = take_pixel,
                                 .user = &job});
}
