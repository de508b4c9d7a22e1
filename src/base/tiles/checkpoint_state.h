// SPDX-License-Identifier: MIT
// The state file of a checkpoint: text lines "name value", the last a checksum of those before. It
// is written to PATH.new, flushed and renamed; the state before it stays as PATH.old.
#ifndef ALPI_BASE_CHECKPOINT_STATE_H
#define ALPI_BASE_CHECKPOINT_STATE_H

#include "base/context.h"

/// The state of one process of a bake. Texts are borrowed when it is written, and lie in `text`
/// when it was read. None has a line end, but settings.
typedef struct alpi_checkpoint_state {
    const char *phase; // "running", "stopped" or "complete"
    const char *stage; // of the bake
    uint64_t done, total;
    double seconds;        // since the process began
    double seconds_left;   // of the stage; negative while unknown
    double error;          // stated so far, relative; NaN while unknown
    uint64_t tiles;        // that were run
    uint64_t written;      // seconds since 1970
    uint32_t shard, count; // of shards, from 0; count 0: no shard
    const char *restart;   // how the caller runs this bake again; opaque
    const char *settings;  // lines "name value\n" of all that changes a result
    char *text;            // owned, or NULL
} alpi_checkpoint_state;

/// @return false: errno says why; the state before it is kept
bool alpi_checkpoint_state_write(alp_context *context, const char *path,
                                 const alpi_checkpoint_state *state);
/// Reads PATH, or PATH.old if PATH is missing or damaged. Free with alpi_checkpoint_state_clear.
/// @param damaged out: PATH is there and damaged   @return false: neither can be read
bool alpi_checkpoint_state_read(alp_context *context, const char *path,
                                alpi_checkpoint_state *state, bool *damaged);
void alpi_checkpoint_state_clear(alp_context *context, alpi_checkpoint_state *state);

#endif
