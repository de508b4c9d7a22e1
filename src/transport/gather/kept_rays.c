// SPDX-License-Identifier: MIT
#include "transport/gather/kept_rays.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "base/tiles/rank_calls.h"

#include <assert.h>

// Rays. Loops that trace and loops that read have the same tiles, so that a rank finds its rays.
enum { RAYS_PER_RANGE = 4096 };
enum { AHEAD = 4 }; // packets: their cells are asked for while others are added

uint64_t alpi_kept_rays_size(const alpi_gatherer *gatherer)
{
    return (uint64_t)gatherer->packet_count * ALPI_PACKET * sizeof(uint32_t);
}

alp_result alpi_kept_rays_fit(alp_context *context, uint64_t bytes, uint64_t most, bool *fit)
{
    const uint64_t left = alpi_memory_left(context), spare = alpi_memory_held(context) / 4;
    const uint64_t room = left == UINT64_MAX ? left : left > spare ? left - spare : 0;
    uint64_t limit = room < most ? room : most;
    ALP_TRY(alpi_ranks_lowest(context, &limit));
    *fit = bytes <= limit;
    alpi_tiles_note_choice(context, *fit);
    return ALP_OK;
}

alp_result alpi_kept_rays_reserve(alp_context *context, const alpi_gatherer *gatherer,
                                  uint32_t count, alpi_kept_rays *kept)
{
    const uint32_t rays = gatherer->packet_count * ALPI_PACKET;
    uint32_t *cells = alpi_reallocate(context, kept->cells, count, rays * sizeof *cells);
    if (cells == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    kept->context = context;
    kept->cells = cells;
    uint8_t *traced = alpi_reallocate(context, kept->traced, count, sizeof *traced);
    if (traced == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    kept->traced = traced;
    kept->receivers = count;
    kept->rays = rays;
    return ALP_OK;
}

void alpi_kept_rays_destroy(alpi_kept_rays *kept)
{
    if (kept->context != NULL) {
        alpi_release(kept->context, kept->cells);
        alpi_release(kept->context, kept->traced);
    }
    *kept = (alpi_kept_rays){0};
}

typedef struct kept_job {
    const alpi_gather_job *job;
    const alpi_kept_rays *kept;
} kept_job;

static uint32_t receiver_at(const alpi_gather_job *job, uint32_t i)
{
    return job->list != NULL ? job->list[i] : i;
}

static size_t row_of(const kept_job *k, uint32_t i)
{
    return k->kept->by_list ? i : receiver_at(k->job, i);
}

/// The rays of the i-th of the list.
static uint32_t *rays_of(const kept_job *k, uint32_t i)
{
    return k->kept->cells + row_of(k, i) * k->kept->rays;
}

/// Traces the rays of the i-th of the list. @param sums out
static alp_result trace_row(const kept_job *k, uint32_t i, alpi_gather_sums *sums)
{
    const alpi_gather_job *job = k->job;
    const alpi_gatherer *g = job->gatherer;
    uint32_t(*cells)[ALPI_PACKET] = (uint32_t(*)[ALPI_PACKET])rays_of(k, i);
    alpi_gather_packet packets[ALPI_GATHER_BATCH];
    vec3 skies[ALPI_GATHER_BATCH][ALPI_PACKET];
    *sums = (alpi_gather_sums){.lost = {0.0}};
    for (uint32_t first = 0; first < g->packet_count; first += ALPI_GATHER_BATCH) {
        const uint32_t left = g->packet_count - first;
        const uint32_t count = left < ALPI_GATHER_BATCH ? left : ALPI_GATHER_BATCH;
        g->aim(g->user, job->receivers, receiver_at(job, i), first, count, packets, NULL);
        alpi_gather_cells(job->from, packets, count, g->coherent, &cells[first]);
        if (job->from->sky) {
            alpi_gather_find_skies(job->from, packets, count,
                                   (const uint32_t(*)[ALPI_PACKET]) & cells[first], skies);
        }
        for (uint32_t p = 0; p < count; p++) {
            alpi_gather_add_cells(g, first + p, cells[first + p], job->from->light.cells, sums);
            if (job->from->sky) {
                alpi_gather_add_sky(g, first + p, cells[first + p], skies[p], sums);
            }
        }
        if (!alpi_loop_goes_on(job->context)) {
            return ALP_ERROR_CANCELLED;
        }
    }
    k->kept->traced[row_of(k, i)] = 1;
    return ALP_OK;
}

static alp_result trace_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const kept_job *k = user;
    const alpi_gather_job *job = k->job;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t receiver = receiver_at(job, i);
        alpi_gather_sums sums;
        ALP_TRY(trace_row(k, i, &sums));
        for (int c = 0; c < 3 && job->skies != NULL; c++) {
            job->skies[receiver][c] = (float)(ALPI_PI * sums.sky[c]);
        }
        for (int c = 0; c < 2 && job->lost != NULL; c++) {
            job->lost[receiver][c] = (float)sums.lost[c];
        }
    }
    return ALP_OK;
}

/// Runs a body over the listed receivers.
static alp_result run(kept_job *k, alpi_tile_loop loop, const alpi_gather_job *written)
{
    const uint32_t rays = k->kept->rays;
    alpi_tile_output outputs[ALPI_GATHER_OUTPUTS];
    assert(!k->kept->by_list || k->job->count <= k->kept->receivers);
    alpi_gather_outputs(written, outputs);
    loop.count = k->job->count;
    loop.grain = rays < RAYS_PER_RANGE ? RAYS_PER_RANGE / rays : 1;
    loop.key = alpi_gather_key(k->job);
    loop.user = k;
    loop.outputs = outputs;
    loop.output_count = ALPI_GATHER_OUTPUTS;
    return alpi_tile_loop_run(k->job->context, &loop);
}

alp_result alpi_kept_rays_trace(const alpi_gather_job *job, const alpi_task_progress *progress,
                                alpi_kept_rays *kept)
{
    alpi_gather_check(job->gatherer);
    kept_job k = {job, kept};
    alpi_task_progress told = progress != NULL ? *progress : (alpi_task_progress){0};
    told.units_per_item = (double)kept->rays;
    told.units_are_rays = true;
    alpi_gather_job written = *job;
    written.values = NULL;
    written.directional = NULL;
    return run(&k,
               (alpi_tile_loop){.name = "first rays",
                                .body = trace_range,
                                .progress = &told,
                                .marks = job->marks,
                                .mark_count = job->mark_count,
                                .fills_cache = true},
               &written);
}

static alp_result gather_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const kept_job *k = user;
    const alpi_gather_job *job = k->job;
    alpi_gather_job without_sky = *job;
    without_sky.skies = NULL;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t receiver = receiver_at(job, i);
        const uint32_t(*cells)[ALPI_PACKET] = (const uint32_t(*)[ALPI_PACKET])rays_of(k, i);
        alpi_gather_sums sums;
        if (k->kept->traced[row_of(k, i)] == 0) {
            ALP_TRY(trace_row(k, i, &sums));
        }
        sums = (alpi_gather_sums){.lost = {0.0}};
        for (uint32_t p = 0; p < job->gatherer->packet_count; p++) {
            for (int r = 0; r < ALPI_PACKET && p + AHEAD < job->gatherer->packet_count; r++) {
                __builtin_prefetch(job->from->light.cells[cells[p + AHEAD][r]]);
            }
            alpi_gather_add_cells(job->gatherer, p, cells[p], job->from->light.cells, &sums);
        }
        alpi_gather_write(&without_sky, receiver, &sums);
    }
    return ALP_OK;
}

alp_result alpi_kept_rays_gather(const alpi_gather_job *job, const alpi_kept_rays *kept,
                                 const alpi_task_progress *progress)
{
    alpi_gather_check(job->gatherer);
    kept_job k = {job, kept};
    alpi_gather_job written = *job;
    written.skies = NULL;
    return run(
        &k,
        (alpi_tile_loop){
            .name = "kept rays", .body = gather_range, .progress = progress, .reads_cache = true},
        &written);
}
