// SPDX-License-Identifier: MIT
// Tile loops: parallel loops whose results can be stored, sent to other processes, and read back.
// The loops that trace rays are tile loops; others are run again by each process.
//
// A loop's items are cut into tiles of `grain` items. A tile's results are the elements of the
// outputs that its items own, so they can be copied without knowledge of their meaning.
#ifndef ALPI_BASE_TILES_H
#define ALPI_BASE_TILES_H

#include "base/tasks.h"

/// An array that the items of a loop write. Item i owns elements [i × each, (i + 1) × each) of the
/// list, and reads none of the others'.
typedef struct alpi_tile_output {
    void *data;           // NULL: there is none
    size_t size;          // bytes of an element
    const uint32_t *list; // [count] place of each element in `data`; NULL: in order
    uint32_t count;       // elements; the last item may own fewer than `each`
    uint32_t each;        // elements of an item; 0 = 1
} alpi_tile_output;

typedef struct alpi_tile_loop {
    const char *name; // fixed; part of the loop's shape
    uint64_t key;     // of all that its results follow from besides its lists: samples, seed
    uint32_t count;   // items
    uint32_t grain;   // items of a tile
    alpi_task_fn *body;
    void *user;
    const alpi_task_progress *progress; // NULL: silent
    const alpi_tile_output *outputs;    // [output_count]
    uint32_t output_count;
    // Bytes that any item may set and none reads, or NULL. Processes combine them by "or". A loop
    // with marks is never stored: a resumed process runs it again.
    uint8_t *marks;
    size_t mark_count;
    // The body fills a cache that is neither stored nor sent. A resumed process runs the loop
    // again.
    bool fills_cache;
    // The body reads such a cache, and fills what it lacks. A rank runs its own part alone: tiles
    // of others would fill the cache again.
    bool reads_cache;
} alpi_tile_loop;

/// Runs a loop as alpi_parallel_for does. Tiles of a checkpoint are read instead of run. With
/// ranks, each process runs some tiles and receives the others. A shard runs its own tiles alone of
/// loops that are SPLIT.
/// @return ALP_OK; the failure of the lowest failing range; CANCELLED; IO (ranks that fail, or that
///         run different loops); OUT_OF_MEMORY
alp_result alpi_tile_loop_run(alp_context *context, const alpi_tile_loop *loop);

/// The loops of a bake, by how shards run them. Loops of a kind are numbered, and a number is the
/// same loop in every process.
typedef enum alpi_tile_kind {
    ALPI_TILES_WHOLE = 0, // every shard runs all tiles
    ALPI_TILES_SPLIT,     // each shard runs its own: no later loop chooses its items by them
    ALPI_TILES_MEASURE,   // of the stated error; shards leave them to the merge
    ALPI_TILE_KINDS
} alpi_tile_kind;
/// Sets the kind of the following loops. @return the former one
alpi_tile_kind alpi_tiles_set_kind(alp_context *context, alpi_tile_kind kind);

/// Notes a choice between loops that depends on the machine. It changes the shape of the following
/// loops of the kind: a process that chose otherwise reads none of their tiles.
void alpi_tiles_note_choice(alp_context *context, bool choice);
/// Fingerprint of a loop and of the choices before it.
uint64_t alpi_tiles_shape(alp_context *context, const alpi_tile_loop *loop);

/// Whether this process is a shard: its arrays lack the tiles of others.
bool alpi_tiles_are_shards(alp_context *context);

struct alpi_checkpoint;
/// The tiles of a context: who runs them, and where they are kept.
typedef struct alpi_tiles {
    struct alpi_checkpoint *checkpoint; // or NULL
    uint32_t shard, shards;             // shard in [0, shards); shards 0: the whole
    alpi_tile_kind kind;                // of the loops that follow
    bool merging;                       // tiles are read from shards; see missing
    uint32_t next[ALPI_TILE_KINDS];     // number of the next loop of each kind
    uint64_t choices[ALPI_TILE_KINDS];  // hash of those noted so far
    uint32_t number;                    // of the loop that runs, with its kind
    bool together;                      // ranks began work, and share loops
    uint64_t claims;                    // calls of ranks so far: the number of the next loop
    uint64_t ran, skipped, read;        // tiles of this bake so far
    double split_seconds;               // a shard: in loops that are SPLIT
    bool *missing;                      // [shards] merging: shards whose tiles are not there
} alpi_tiles;

#endif
