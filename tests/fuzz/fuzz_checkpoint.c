// SPDX-License-Identifier: MIT
// Fuzz target: files of checkpoints. The first byte of an input picks what the others are: the text
// of a state, a log, or packed tiles. Checksums are also put right, or no change would get past
// them.
#include "fuzz.h"

#include "base/hash.h"
#include "base/tiles/checkpoint.h"
#include "base/tiles/tile_log.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { KEY = 7, FILE_HEAD = 24, CHECKSUM_LINE = 26, PLACES = 300, ITEMS = 100, TILES = 13 };

static const char *write_input(const char *name, const uint8_t *bytes, size_t size)
{
    static char path[320];
    snprintf(path, sizeof path, "%s/%s", fuzz_folder(), name);
    (void)unlink(path); // a new file: some file systems flush one that is written again
    FILE *file = fopen(path, "wb");
    if (file == NULL || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) {
        fuzz_abort("cannot write %s", path);
    }
    return path;
}

// --- state ---------------------------------------------------------------------------------------

static void read_state(fuzz_run *run, const uint8_t *bytes, size_t size)
{
    alpi_checkpoint_state s;
    bool damaged = false;
    if (!alpi_checkpoint_state_read(run->context, write_input("bake.state", bytes, size), &s,
                                    &damaged)) {
        return;
    }
    if (!(s.seconds >= 0.0) || (s.count > 0 && s.shard >= s.count) ||
        strchr(s.phase, '\n') != NULL || strchr(s.stage, '\n') != NULL ||
        strchr(s.restart, '\n') != NULL) {
        fuzz_abort("a state that no process writes was read");
    }
    alpi_checkpoint_state_clear(run->context, &s);
}

static void read_states(fuzz_run *run, const uint8_t *bytes, size_t size)
{
    char line[CHECKSUM_LINE + 1];
    uint8_t *text = malloc(size + CHECKSUM_LINE);
    if (text == NULL) {
        fuzz_abort("no memory for an input");
    }
    read_state(run, bytes, size);
    if (size > 0) {
        memcpy(text, bytes, size);
    }
    snprintf(line, sizeof line, "checksum %016llx\n",
             (unsigned long long)alpi_hash_bytes(ALPI_HASH_START, bytes, size));
    memcpy(text + size, line, CHECKSUM_LINE);
    read_state(run, text, size + CHECKSUM_LINE);
    free(text);
}

// --- tiles ---------------------------------------------------------------------------------------

/// A loop of 100 items with three kinds of outputs.
static void unpack(const uint8_t *bytes, size_t size)
{
    static uint8_t small[ITEMS], large[PLACES][12];
    static uint32_t list[PLACES];
    static _Atomic uint8_t states[TILES];
    for (uint32_t i = 0; i < PLACES; i++) {
        list[i] = PLACES - 1 - i;
    }
    for (uint32_t t = 0; t < TILES; t++) {
        states[t] = ALPI_TILE_OPEN;
    }
    const alpi_tile_output outputs[] = {
        {.data = small, .size = 1, .count = ITEMS},
        {.data = NULL, .size = 8, .count = ITEMS},
        {.data = large, .size = 12, .list = list, .count = PLACES - 2, .each = 3}};
    const alpi_tile_loop loop = {
        .name = "fuzz", .count = ITEMS, .grain = 8, .outputs = outputs, .output_count = 3};
    const bool good = alpi_tile_unpack(&loop, bytes, size, states);
    for (uint32_t t = 0; t < TILES; t++) {
        if (states[t] != ALPI_TILE_OPEN && (!good || states[t] != ALPI_TILE_READ)) {
            fuzz_abort("tile %u has state %u", t, states[t]);
        }
    }
}

// --- log -----------------------------------------------------------------------------------------

/// Puts the checksums of heads right, as far as heads follow each other.
static void mend_log(uint8_t *bytes, size_t size)
{
    const uint64_t key = KEY;
    if (size < FILE_HEAD) {
        return;
    }
    memcpy(bytes + 8, &key, sizeof key);
    const uint64_t own = alpi_hash_bytes(ALPI_HASH_START, bytes, 16);
    memcpy(bytes + 16, &own, sizeof own);
    alpi_tile_head head;
    for (size_t at = FILE_HEAD; size - at >= sizeof head;) {
        memcpy(&head, bytes + at, sizeof head);
        const size_t left = size - at - sizeof head;
        if (head.size <= left) {
            head.checksum = alpi_tile_checksum(bytes + at + sizeof head, (size_t)head.size);
        }
        head.own = alpi_hash_bytes(ALPI_HASH_START, &head, offsetof(alpi_tile_head, own));
        memcpy(bytes + at, &head, sizeof head);
        if (head.size > left) {
            break;
        }
        at += sizeof head + (size_t)head.size;
    }
}

static void read_records(const alpi_tile_log *log, size_t size)
{
    uint64_t end = FILE_HEAD;
    for (size_t i = 0; i < log->count; i++) {
        const alpi_tile_record *r = &log->records[i];
        uint8_t *bytes = r->head.size <= size ? malloc((size_t)r->head.size + 1) : NULL;
        if (bytes == NULL || r->offset < end + sizeof r->head || r->offset + r->head.size > size) {
            fuzz_abort("record %zu lies outside of the file", i);
        }
        if (alpi_tile_log_read(log, r, bytes)) {
            unpack(bytes, (size_t)r->head.size);
        }
        end = r->offset + r->head.size;
        free(bytes);
    }
}

/// Reads as another process, or as the one that appends to it.
static void read_log(fuzz_run *run, const uint8_t *bytes, size_t size, bool writes)
{
    alpi_tile_log log;
    const char *path = write_input("bake.tiles", bytes, size);
    const alp_result result = alpi_tile_log_open(run->context, path, KEY, writes, &log);
    fuzz_result(run, result, log.context);
    if (result == ALP_OK) {
        read_records(&log, size);
        alpi_tile_log_close(&log);
    }
}

static void read_logs(fuzz_run *run, const uint8_t *bytes, size_t size)
{
    uint8_t *copy = fuzz_copy(bytes, size);
    read_log(run, copy, size, false);
    mend_log(copy, size);
    read_log(run, copy, size, true);
    free(copy);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run run = fuzz_begin(size);
    const size_t rest = size > 0 ? size - 1 : 0;
    uint8_t *bytes = fuzz_copy(data + size - rest, rest);
    switch (size > 0 ? data[0] : 0) {
    case 's':
        read_states(&run, bytes, rest);
        break;
    case 'l':
        read_logs(&run, bytes, rest);
        break;
    default:
        unpack(bytes, rest);
    }
    free(bytes);
    fuzz_end(&run);
    return 0;
}
