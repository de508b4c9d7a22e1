// SPDX-License-Identifier: MIT
// Files of checkpoints: states, and a log of the loop of fuzz_checkpoint.c with its packed tiles.
#include "seeds.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/tiles/checkpoint_state.h"
#include "base/tiles/tile_log.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { KEY = 7, CHECKSUM_LINE = 26 };

/// Puts the first bytes of a file behind the letter of its kind.
static void put_file(alp_context *context, const char *path, char kind, size_t cut,
                     const char *name)
{
    uint8_t *bytes = NULL, *input = NULL;
    size_t size = 0;
    if (alpi_file_read(context, path, 1 << 20, &bytes, &size) != ALP_OK) {
        seed_fail(alp_context_message(context));
    }
    input = ALPI_NEW(context, uint8_t, size + 1);
    if (input != NULL) {
        input[0] = (uint8_t)kind;
        memcpy(input + 1, bytes, size - cut);
        seed_put("checkpoint", name, input, 1 + size - cut);
    }
    alpi_release(context, input);
    alpi_release(context, bytes);
    unlink(path);
}

static void put_state(alp_context *context, const char *path)
{
    const alpi_checkpoint_state state = {.phase = "running",
                                         .stage = "light",
                                         .done = 5,
                                         .total = 9,
                                         .seconds = 1.5,
                                         .seconds_left = -1.0,
                                         .error = .25,
                                         .written = 1700000000,
                                         .shard = 2,
                                         .count = 5,
                                         .restart = "{}",
                                         .settings = "--size 8\n--seed 0\n"};
    for (int whole = 0; whole < 2; whole++) {
        if (!alpi_checkpoint_state_write(context, path, &state)) {
            seed_fail(path);
        }
        put_file(context, path, 's', whole ? 0 : CHECKSUM_LINE, whole ? "state" : "text");
    }
}

/// 100 items: a byte each, and three of 12 bytes each, of which the last has one.
static alpi_bytes pack(alp_context *context, uint32_t tiles)
{
    static uint8_t small[100], large[298][12];
    _Atomic uint8_t states[13] = {0};
    const alpi_tile_output outputs[] = {{.data = small, .size = 1, .count = 100},
                                        {.data = large, .size = 12, .count = 298, .each = 3}};
    const alpi_tile_loop loop = {
        .name = "fuzz", .count = 100, .grain = 8, .outputs = outputs, .output_count = 2};
    alpi_bytes bytes = alpi_bytes_create(context);
    uint32_t from = 0;
    for (uint32_t t = 0; t < 13; t++) {
        states[t] = tiles >> t & 1u ? ALPI_TILE_RAN : ALPI_TILE_OPEN;
    }
    (void)alpi_tile_pack(&loop, states, 1u << ALPI_TILE_RAN, false, &from, SIZE_MAX, &bytes);
    return bytes;
}

static void put_log(alp_context *context, const char *path)
{
    alpi_tile_log log;
    if (alpi_tile_log_open(context, path, KEY, true, &log) != ALP_OK) {
        seed_fail(alp_context_message(context));
    }
    for (uint32_t i = 0; i < 2; i++) {
        static const alpi_tile_head room = {0};
        alpi_bytes tiles = pack(context, i == 0 ? 2 : 0x1008), record = alpi_bytes_create(context);
        alpi_bytes_add(&record, &room, sizeof room);
        alpi_bytes_add(&record, tiles.bytes, tiles.size);
        alpi_tile_log_seal(i, 1, 0, &record);
        if (record.failed || !alpi_tile_log_append(&log, record.bytes, record.size)) {
            seed_fail(path);
        }
        alpi_bytes_destroy(&record);
        alpi_bytes_destroy(&tiles);
    }
    alpi_tile_log_close(&log);
    put_file(context, path, 'l', 0, "log");
}

void seeds_checkpoint(alp_context *context)
{
    char folder[] = "/tmp/fuzz-seeds-XXXXXX", path[64];
    if (mkdtemp(folder) == NULL) {
        seed_fail(folder);
    }
    snprintf(path, sizeof path, "%s/file", folder);
    put_state(context, path);
    put_log(context, path);
    rmdir(folder);
    alpi_bytes tiles = alpi_bytes_create(context), packed = pack(context, 0x100d);
    alpi_bytes_add(&tiles, "t", 1);
    alpi_bytes_add(&tiles, packed.bytes, packed.size);
    seed_put("checkpoint", "tiles", tiles.bytes, tiles.size);
    alpi_bytes_destroy(&tiles);
    alpi_bytes_destroy(&packed);
}
