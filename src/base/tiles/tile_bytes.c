// SPDX-License-Identifier: MIT
#include "base/tiles/tile_bytes.h"

#include "base/hash.h"

#include <stdatomic.h>
#include <string.h>

uint32_t alpi_tile_count(const alpi_tile_loop *loop)
{
    const uint32_t grain = loop->grain > 0 ? loop->grain : 1;
    return loop->count / grain + (loop->count % grain != 0);
}

uint32_t alpi_tile_begin(const alpi_tile_loop *loop, uint32_t tile)
{
    const uint64_t begin = (uint64_t)tile * (loop->grain > 0 ? loop->grain : 1);
    return begin < loop->count ? (uint32_t)begin : loop->count;
}

// --- outputs -------------------------------------------------------------------------------------

/// Elements [begin, end) of an output.
typedef struct element_range {
    size_t begin, end;
} element_range;

static element_range elements_of(const alpi_tile_loop *loop, const alpi_tile_output *o,
                                 alpi_tile_run run)
{
    const size_t each = o->each > 0 ? o->each : 1;
    element_range r = {alpi_tile_begin(loop, run.first) * each,
                       alpi_tile_begin(loop, run.first + run.count) * each};
    r.begin = r.begin < o->count ? r.begin : o->count;
    r.end = r.end < o->count ? r.end : o->count;
    return r;
}

size_t alpi_tile_size(const alpi_tile_loop *loop, alpi_tile_run run)
{
    size_t size = 0;
    for (uint32_t i = 0; i < loop->output_count; i++) {
        const alpi_tile_output *o = &loop->outputs[i];
        const element_range r = elements_of(loop, o, run);
        size += o->data != NULL ? (r.end - r.begin) * o->size : 0;
    }
    return size;
}

static uint8_t *element(const alpi_tile_output *o, size_t i)
{
    return (uint8_t *)o->data + (o->list != NULL ? o->list[i] : i) * o->size;
}

static void copy_out(const alpi_tile_loop *loop, alpi_tile_run run, uint8_t *bytes)
{
    for (uint32_t i = 0; i < loop->output_count; i++) {
        const alpi_tile_output *o = &loop->outputs[i];
        const element_range r = elements_of(loop, o, run);
        for (size_t k = r.begin; k < r.end && o->data != NULL; k++, bytes += o->size) {
            memcpy(bytes, element(o, k), o->size);
        }
    }
}

static const uint8_t *copy_in(const alpi_tile_loop *loop, alpi_tile_run run, const uint8_t *bytes)
{
    for (uint32_t i = 0; i < loop->output_count; i++) {
        const alpi_tile_output *o = &loop->outputs[i];
        const element_range r = elements_of(loop, o, run);
        for (size_t k = r.begin; k < r.end && o->data != NULL; k++, bytes += o->size) {
            memcpy(element(o, k), bytes, o->size);
        }
    }
    return bytes;
}

// --- runs ----------------------------------------------------------------------------------------

static bool is_wanted(const _Atomic uint8_t *states, uint32_t tile, unsigned wanted)
{
    return (wanted >> atomic_load_explicit(&states[tile], memory_order_acquire) & 1u) != 0;
}

/// The next run of tiles in the wanted state. @return count 0: there is none
static alpi_tile_run next_run(const alpi_tile_loop *loop, const _Atomic uint8_t *states,
                              unsigned wanted, uint32_t *from, size_t most)
{
    const uint32_t tiles = alpi_tile_count(loop);
    alpi_tile_run run = {0, 0};
    while (*from < tiles && !is_wanted(states, *from, wanted)) {
        ++*from;
    }
    run.first = *from;
    while (*from < tiles && alpi_tile_size(loop, run) < most && is_wanted(states, *from, wanted)) {
        run.count = ++*from - run.first;
    }
    return run;
}

/// Appends runs of tiles in the wanted state. @return how many
static uint32_t add_runs(const alpi_tile_loop *loop, const _Atomic uint8_t *states, unsigned wanted,
                         uint32_t *from, size_t most, alpi_bytes *bytes)
{
    uint32_t count = 0;
    for (size_t size = 0; size < most;) {
        const alpi_tile_run run = next_run(loop, states, wanted, from, most - size);
        if (run.count == 0) {
            break;
        }
        alpi_bytes_add(bytes, &run, sizeof run);
        size += alpi_tile_size(loop, run) + sizeof run;
        count++;
    }
    return count;
}

static alpi_tile_run run_at(const uint8_t *bytes, uint32_t i)
{
    alpi_tile_run run;
    memcpy(&run, bytes + sizeof(uint32_t) + i * sizeof run, sizeof run);
    return run;
}

static void set_states(alpi_tile_run run, uint8_t state, _Atomic uint8_t *states)
{
    for (uint32_t k = 0; k < run.count; k++) {
        atomic_store_explicit(&states[run.first + k], state, memory_order_release);
    }
}

uint32_t alpi_tile_pack(const alpi_tile_loop *loop, _Atomic uint8_t *states, unsigned wanted,
                        bool kept, uint32_t *from, size_t most, alpi_bytes *bytes)
{
    const size_t head = bytes->size;
    uint32_t tiles = 0;
    alpi_bytes_add_u32(bytes, 0);
    const uint32_t count = add_runs(loop, states, wanted, from, most, bytes);
    size_t size = 0;
    for (uint32_t i = 0; i < count && !bytes->failed; i++) {
        size += alpi_tile_size(loop, run_at(bytes->bytes + head, i));
    }
    alpi_bytes_reserve(bytes, size);
    if (bytes->failed) {
        return 0;
    }
    memcpy(bytes->bytes + head, &count, sizeof count);
    for (uint32_t i = 0; i < count; i++) {
        const alpi_tile_run run = run_at(bytes->bytes + head, i);
        copy_out(loop, run, bytes->bytes + bytes->size);
        bytes->size += alpi_tile_size(loop, run);
        tiles += run.count;
        if (kept) {
            set_states(run, ALPI_TILE_KEPT, states);
        }
    }
    return tiles;
}

/// Whether the runs lie in the loop, and their outputs fill the bytes behind them.
static bool runs_fit(const alpi_tile_loop *loop, const uint8_t *bytes, size_t size, uint32_t count)
{
    const uint32_t tiles = alpi_tile_count(loop);
    size_t wanted = sizeof count + count * sizeof(alpi_tile_run);
    for (uint32_t i = 0; i < count; i++) {
        const alpi_tile_run run = run_at(bytes, i);
        if (run.first > tiles || run.count > tiles - run.first) {
            return false;
        }
        wanted += alpi_tile_size(loop, run);
        if (wanted > size) {
            return false;
        }
    }
    return wanted == size;
}

bool alpi_tile_unpack(const alpi_tile_loop *loop, const uint8_t *bytes, size_t size,
                      _Atomic uint8_t *states)
{
    uint32_t count = 0;
    if (size < sizeof count) {
        return false;
    }
    memcpy(&count, bytes, sizeof count);
    if (count > (size - sizeof count) / sizeof(alpi_tile_run) ||
        !runs_fit(loop, bytes, size, count)) {
        return false;
    }
    const uint8_t *at = bytes + sizeof count + count * sizeof(alpi_tile_run);
    for (uint32_t i = 0; i < count; i++) {
        const alpi_tile_run run = run_at(bytes, i);
        at = copy_in(loop, run, at);
        set_states(run, ALPI_TILE_READ, states);
    }
    return true;
}

// --- shape ---------------------------------------------------------------------------------------

static uint64_t add_number(uint64_t hash, uint64_t number)
{
    return alpi_hash_bytes(hash, &number, sizeof number);
}

uint64_t alpi_tile_shape(const alpi_tile_loop *loop)
{
    uint64_t hash = alpi_hash_bytes(ALPI_HASH_START, loop->name, strlen(loop->name));
    hash = add_number(hash, loop->key);
    hash = add_number(hash, loop->count);
    hash = add_number(hash, loop->grain);
    for (uint32_t i = 0; i < loop->output_count; i++) {
        const alpi_tile_output *o = &loop->outputs[i];
        hash = add_number(hash, o->data != NULL ? o->size : 0);
        hash = add_number(hash, o->count);
        hash = add_number(hash, o->each);
        const bool again = i > 0 && o->list == loop->outputs[i - 1].list;
        if (o->list != NULL && !again) {
            hash = alpi_hash_bytes(hash, o->list, o->count * sizeof *o->list);
        }
    }
    return hash;
}
