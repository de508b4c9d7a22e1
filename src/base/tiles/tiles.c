// SPDX-License-Identifier: MIT
#include "base/tiles/tiles.h"

#include "base/hash.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/tiles/checkpoint.h"
#include "base/tiles/rank_calls.h"
#include "base/tiles/tile_bytes.h"

#include <alpenglow/ranks.h>

#include <stdatomic.h>
#include <string.h>

alpi_tile_kind alpi_tiles_set_kind(alp_context *context, alpi_tile_kind kind)
{
    alpi_tiles *tiles = alpi_context_tiles(context);
    const alpi_tile_kind former = tiles->kind;
    tiles->kind = kind;
    return former;
}

void alpi_tiles_note_choice(alp_context *context, bool choice)
{
    alpi_tiles *tiles = alpi_context_tiles(context);
    uint64_t *choices = &tiles->choices[tiles->kind];
    const uint8_t byte = choice ? 2 : 1;
    *choices = alpi_hash_bytes(*choices > 0 ? *choices : ALPI_HASH_START, &byte, sizeof byte);
}

uint64_t alpi_tiles_shape(alp_context *context, const alpi_tile_loop *loop)
{
    const alpi_tiles *tiles = alpi_context_tiles(context);
    return alpi_tile_shape(loop) ^ tiles->choices[tiles->kind];
}

bool alpi_tiles_are_shards(alp_context *context)
{
    const alpi_tiles *tiles = alpi_context_tiles(context);
    return tiles->shards > 0 && !tiles->merging;
}

enum { KIND_SHIFT = 28 };

/// One loop while it runs.
typedef struct tile_run {
    const alpi_tile_loop *loop;
    alp_context *context;
    alpi_tiles *tiles;
    const alp_ranks *ranks;  // NULL: one process
    uint32_t count;          // tiles
    _Atomic uint8_t *states; // [count] of alpi_tile_state
    const uint32_t *picked;  // tiles of the batch; NULL: all
    alpi_task_progress progress;
} tile_run;

// --- tiles ---------------------------------------------------------------------------------------

/// Whether the shard of this process leaves a tile to others.
static bool is_of_others(const tile_run *r, uint32_t tile)
{
    const alpi_tiles *t = r->tiles;
    return t->kind == ALPI_TILES_SPLIT && alpi_tiles_are_shards(r->context) &&
           tile % t->shards != t->shard;
}

static alp_result run_tiles(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    tile_run *r = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t tile = r->picked != NULL ? r->picked[i] : i;
        if (atomic_load_explicit(&r->states[tile], memory_order_relaxed) == ALPI_TILE_OPEN &&
            !is_of_others(r, tile)) {
            ALP_TRY(r->loop->body(r->loop->user, alpi_tile_begin(r->loop, tile),
                                  alpi_tile_begin(r->loop, tile + 1), worker));
            atomic_store_explicit(&r->states[tile], ALPI_TILE_RAN, memory_order_release);
        }
        if (worker == 0 && r->ranks != NULL && r->ranks->poll != NULL) {
            r->ranks->poll(r->ranks->user);
        }
    }
    return ALP_OK;
}

/// Progress of the loop in units of a tile.
static alpi_task_progress progress_of(const alpi_tile_loop *loop, uint32_t tiles)
{
    alpi_task_progress p =
        loop->progress != NULL ? *loop->progress : (alpi_task_progress){.callback = NULL};
    const double each = p.units_per_item > 0.0 ? p.units_per_item : 1.0;
    p.units_total = p.units_total > 0.0 ? p.units_total : p.units_before + each * loop->count;
    p.units_per_item = each * loop->count / tiles;
    p.started = p.started > 0.0 ? p.started : alpi_seconds();
    return p;
}

// --- ranks ---------------------------------------------------------------------------------------

// A loop is cut into BLOCKS rows of n blocks, for n ranks, whatever the size of its tiles. Each
// part has a block of every row, at a place that turns at random from row to row: parts cost about
// the same, also where few blocks have a tile. Loops over the same items, some of which fill a
// cache of rays, have the same parts. Each rank claims blocks of its own part first, then those of
// the parts 1, 2, 4 … further on, but not in a loop that reads a cache. scripts/replay_scale.py
// replays this.
enum { BLOCKS = 128 };

static uint32_t block_begin(const tile_run *r, uint64_t block)
{
    return (uint32_t)(r->count * block / ((uint64_t)BLOCKS * r->ranks->count));
}

/// Runs some blocks of a part. @param list room for their tiles
static alp_result run_blocks(tile_run *r, uint32_t part, uint64_t first, uint64_t end,
                             uint32_t *list)
{
    const uint32_t n = r->ranks->count;
    uint32_t count = 0;
    for (uint64_t i = first; i < end; i++) {
        const uint64_t turn = (uint64_t)alpi_hash32((uint32_t)i) * n >> 32;
        const uint64_t block = i * n + (part + turn) % n;
        const uint32_t last = block_begin(r, block + 1);
        for (uint32_t tile = block_begin(r, block); tile < last; tile++) {
            list[count++] = tile;
        }
    }
    r->picked = list;
    ALP_TRY(alpi_parallel_for(r->context, count, 1, run_tiles, r, &r->progress));
    r->progress.units_before += r->progress.units_per_item * count * n;
    return ALP_OK;
}

/// Claims blocks of a part, `most` at once, and runs them, until none is left.
static alp_result run_part(tile_run *r, uint32_t part, uint32_t most, uint32_t *list)
{
    for (;;) {
        const uint64_t first = r->ranks->claim(r->ranks->user, r->tiles->claims, part, most);
        if (first == UINT64_MAX) {
            return alpi_fail(r->context, ALP_ERROR_IO, "rank %u: another rank cannot be reached",
                             r->ranks->rank);
        }
        if (first >= BLOCKS) {
            return ALP_OK;
        }
        const uint64_t end = first + most < BLOCKS ? first + most : BLOCKS;
        ALP_TRY(run_blocks(r, part, first, end, list));
    }
}

/// Blocks claimed at once: enough tiles for all workers.
static uint32_t batch_size(const tile_run *r)
{
    const uint32_t workers = alp_context_worker_count(r->context);
    const uint64_t wanted = workers > 1 ? 4 * (uint64_t)workers : 1;
    const uint64_t blocks = wanted * BLOCKS * r->ranks->count / r->count + 1;
    return (uint32_t)(blocks < BLOCKS ? blocks : BLOCKS);
}

static alp_result run_parts(tile_run *r)
{
    const uint32_t n = r->ranks->count, own = r->ranks->rank, most = batch_size(r);
    const uint32_t room = most * (r->count / BLOCKS / n + 1);
    uint32_t *list = ALPI_NEW(r->context, uint32_t, room);
    alp_result result = list != NULL ? run_part(r, own, most, list) : ALP_ERROR_OUT_OF_MEMORY;
    const bool claims_others = !r->loop->reads_cache;
    for (uint64_t step = 1; claims_others && step < n && result == ALP_OK; step *= 2) {
        result = run_part(r, (uint32_t)((own + step) % n), most, list);
    }
    for (uint32_t i = 0; i < n && result != ALP_OK; i++) { // leaves none to the others
        (void)r->ranks->claim(r->ranks->user, r->tiles->claims, i, UINT32_MAX);
    }
    alpi_release(r->context, list);
    return result;
}

/// Takes the marks and tiles of another rank.
static bool take(void *user, uint32_t rank, const uint8_t *bytes, size_t size)
{
    const tile_run *r = user;
    (void)rank;
    if (size < r->loop->mark_count) {
        return false;
    }
    for (size_t i = 0; i < r->loop->mark_count; i++) {
        r->loop->marks[i] |= bytes[i];
    }
    return alpi_tile_unpack(r->loop, bytes + r->loop->mark_count, size - r->loop->mark_count,
                            r->states);
}

static alp_result check_complete(const tile_run *r)
{
    for (uint32_t i = 0; i < r->count; i++) {
        if (r->states[i] == ALPI_TILE_OPEN) {
            return alpi_fail(r->context, ALP_ERROR_IO,
                             "a rank reads tiles of the checkpoint that others cannot read; "
                             "--checkpoint needs a folder that all ranks share");
        }
    }
    return ALP_OK;
}

/// Sends the tiles that this rank ran, with its result, and takes those of the others.
static alp_result exchange(tile_run *r, alp_result result)
{
    static const alpi_rank_head room = {0};
    alpi_bytes bytes = alpi_bytes_create(r->context);
    uint32_t from = 0;
    if (result == ALP_OK) {
        alpi_bytes_add(&bytes, &room, sizeof room);
        alpi_bytes_add(&bytes, r->loop->marks, r->loop->mark_count);
        (void)alpi_tile_pack(r->loop, r->states, 1u << ALPI_TILE_RAN | 1u << ALPI_TILE_KEPT, false,
                             &from, SIZE_MAX, &bytes);
    }
    const alpi_rank_call call = {.shape = alpi_tiles_shape(r->context, r->loop),
                                 .number = r->tiles->number,
                                 .result = bytes.failed ? ALP_ERROR_OUT_OF_MEMORY : result,
                                 .bytes = bytes.bytes,
                                 .size = bytes.size,
                                 .take = take,
                                 .user = r};
    result = alpi_rank_exchange(r->context, &call);
    alpi_bytes_destroy(&bytes);
    return result == ALP_OK ? check_complete(r) : result;
}

// --- a loop --------------------------------------------------------------------------------------

/// Notes which shards' tiles are missing. @return whether any is
static bool find_missing(const tile_run *r)
{
    bool any = false;
    const alpi_tiles *t = r->tiles;
    for (uint32_t i = 0; i < r->count && t->merging && t->kind == ALPI_TILES_SPLIT; i++) {
        if (r->states[i] == ALPI_TILE_OPEN) {
            t->missing[i % t->shards] = true;
            any = true;
        }
    }
    return any;
}

static void count_tiles(const tile_run *r)
{
    for (uint32_t i = 0; i < r->count; i++) {
        const uint8_t state = r->states[i];
        r->tiles->ran += state == ALPI_TILE_RAN || state == ALPI_TILE_KEPT ? 1 : 0;
        r->tiles->read += state == ALPI_TILE_READ ? 1 : 0;
        r->tiles->skipped += state == ALPI_TILE_OPEN ? 1 : 0;
    }
}

static alp_result run(tile_run *r)
{
    alpi_tiles *t = r->tiles;
    if (t->checkpoint != NULL) {
        (void)alpi_checkpoint_begin_loop(t->checkpoint, r->loop, t->number, r->states);
    }
    alp_result result = ALP_OK;
    const double began = alpi_seconds();
    if (!find_missing(r)) {
        result = r->ranks != NULL
                     ? run_parts(r)
                     : alpi_parallel_for(r->context, r->count, 1, run_tiles, r, &r->progress);
    }
    if (r->ranks != NULL) {
        result = exchange(r, result);
    }
    if (t->checkpoint != NULL) {
        alpi_checkpoint_end_loop(t->checkpoint);
    }
    t->split_seconds += t->kind == ALPI_TILES_SPLIT ? alpi_seconds() - began : 0.0;
    count_tiles(r);
    return result;
}

alp_result alpi_tile_loop_run(alp_context *context, const alpi_tile_loop *loop)
{
    alpi_tiles *tiles = alpi_context_tiles(context);
    const alp_ranks *ranks = alpi_ranks_now(context);
    if (loop->count == 0) {
        return ALP_OK;
    }
    tiles->number = (uint32_t)tiles->kind << KIND_SHIFT | tiles->next[tiles->kind]++;
    if (tiles->checkpoint == NULL && ranks == NULL && tiles->shards == 0) {
        return alpi_parallel_for(context, loop->count, loop->grain, loop->body, loop->user,
                                 loop->progress);
    }
    tile_run r = {.loop = loop,
                  .context = context,
                  .tiles = tiles,
                  .ranks = ranks,
                  .count = alpi_tile_count(loop)};
    r.progress = progress_of(loop, r.count);
    r.states = alpi_allocate(context, r.count, sizeof *r.states);
    if (r.states == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result = run(&r);
    alpi_release(context, r.states);
    return result;
}
