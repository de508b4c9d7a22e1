// SPDX-License-Identifier: MIT
// The bytes of tiles: runs of tiles that follow each other, and their outputs.
#ifndef ALPI_BASE_TILE_BYTES_H
#define ALPI_BASE_TILE_BYTES_H

#include "base/bytes.h"
#include "base/tiles/tiles.h"

typedef enum alpi_tile_state {
    ALPI_TILE_OPEN = 0, // not run
    ALPI_TILE_RAN,      // by this process
    ALPI_TILE_KEPT,     // by this process, and copied for a checkpoint
    ALPI_TILE_READ      // from a checkpoint, or received from another rank
} alpi_tile_state;

/// Tiles of a loop.
uint32_t alpi_tile_count(const alpi_tile_loop *loop);
/// Items of the tiles before `tile`.
uint32_t alpi_tile_begin(const alpi_tile_loop *loop, uint32_t tile);
/// Tiles [first, first + count).
typedef struct alpi_tile_run {
    uint32_t first, count;
} alpi_tile_run;
/// Bytes of the outputs of a run.
size_t alpi_tile_size(const alpi_tile_loop *loop, alpi_tile_run run);

/// Appends tiles whose state has its bit in `wanted`, from `from` on, at most about `most` bytes:
/// the number of runs, the runs, then their outputs.
/// @param from in and out: the first tile that was not visited
/// @param kept packed tiles whose state is RAN become KEPT
/// @return tiles packed; 0 if there are none, or bytes->failed
uint32_t alpi_tile_pack(const alpi_tile_loop *loop, _Atomic uint8_t *states, unsigned wanted,
                        bool kept, uint32_t *from, size_t most, alpi_bytes *bytes);
/// Copies packed tiles to the outputs; their states become READ.
/// @return false: the bytes are no tiles of this loop; nothing was copied then
bool alpi_tile_unpack(const alpi_tile_loop *loop, const uint8_t *bytes, size_t size,
                      _Atomic uint8_t *states);
/// Fingerprint of a loop: its name, counts, sizes and lists. Loops of one shape have results of the
/// same layout for the same receivers.
uint64_t alpi_tile_shape(const alpi_tile_loop *loop);

#endif
