// SPDX-License-Identifier: MIT
// A checkpoint: a folder that keeps the finished tiles of a bake. The same bake, run again, reads
// them and goes on.
//
// FOLDER/NAME.tiles  log of tiles of one process (tile_log.h)
// FOLDER/NAME.state  its settings and progress (checkpoint_state.h)
//
// A thread copies finished tiles and appends them at each interval, beside the loop that runs. A
// process that ends at any moment loses the tiles since the last interval, and no others.
#ifndef ALPI_BASE_CHECKPOINT_H
#define ALPI_BASE_CHECKPOINT_H

#include "base/tiles/checkpoint_state.h"
#include "base/tiles/tiles.h"

typedef struct alpi_checkpoint_options {
    const char *folder;
    const char *name;       // of this process: "bake", "rank-3", "shard-2"
    const char *settings;   // lines "name value\n" of all that changes a result
    const char *restart;    // one line, see alpi_checkpoint_state; may be NULL
    double every;           // seconds between two writes
    uint32_t shard, shards; // this one, from 0, of so many; shards 0: none
    bool merging;           // reads all shards and writes nothing
    uint32_t rank, ranks;   // this one of so many; ranks 0: one process
} alpi_checkpoint_options;

typedef struct alpi_checkpoint alpi_checkpoint;

/// Opens a checkpoint, or makes it. A shard reads its own tiles, a merge those of all shards, other
/// processes all that are there.
/// @return ALP_OK; INVALID_ARGUMENT (the folder keeps another bake; the message names the
///         difference); IO; OUT_OF_MEMORY
alp_result alpi_checkpoint_open(alp_context *context, const alpi_checkpoint_options *options,
                                alpi_checkpoint **checkpoint);

/// Whether tiles of an earlier process were found.
bool alpi_checkpoint_resumes(const alpi_checkpoint *checkpoint);

/// Begins a loop: copies stored tiles to the outputs.
/// @param number of the loop in the bake
/// @param states [tiles] alpi_tile_state. In: all OPEN. Out: READ for stored tiles. While the loop
///               runs, finished tiles become RAN, and KEPT once they are copied
/// @return tiles read
uint32_t alpi_checkpoint_begin_loop(alpi_checkpoint *checkpoint, const alpi_tile_loop *loop,
                                    uint32_t number, _Atomic uint8_t *states);
/// Ends it: copies the tiles that the thread has not copied.
void alpi_checkpoint_end_loop(alpi_checkpoint *checkpoint);

/// Notes for the state file.
void alpi_checkpoint_note_progress(alpi_checkpoint *checkpoint, const char *stage, uint64_t done,
                                   uint64_t total, double seconds_left);
void alpi_checkpoint_note_error(alpi_checkpoint *checkpoint, double error);

/// Writes what is left and closes; NULL does nothing.
/// @param complete the result is written: tiles are removed, unless shards are to be merged
void alpi_checkpoint_close(alpi_checkpoint *checkpoint, bool complete);

/// Lists the states of a folder. @param names of files, without ".state"; owned like the states
typedef struct alpi_checkpoint_list {
    alp_context *context;
    alpi_checkpoint_state *states; // [count]
    char **names;                  // [count] in the order of strcmp
    size_t count;
    size_t damaged; // files that cannot be read, with their older ones
} alpi_checkpoint_list;
/// @return ALP_OK (a missing folder has none); IO; OUT_OF_MEMORY
alp_result alpi_checkpoint_list_states(alp_context *context, const char *folder,
                                       alpi_checkpoint_list *list);
/// Whether the tiles of a process are there, and no process holds their lock.
bool alpi_checkpoint_is_free(alp_context *context, const char *folder, const char *name);
void alpi_checkpoint_list_clear(alpi_checkpoint_list *list);

#endif
