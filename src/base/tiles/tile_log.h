// SPDX-License-Identifier: MIT
// The log of tiles: a file to which records of finished tiles are appended. Every record has a
// checksum, so that a damaged record costs its own tiles alone.
//
// file:   "ALPTILE1", key (u64), checksum of both (u64); then records
// record: head (below), then `size` bytes of packed tiles
// Numbers have the byte order of the machine; the key tells machines apart.
#ifndef ALPI_BASE_TILE_LOG_H
#define ALPI_BASE_TILE_LOG_H

#include "base/bytes.h"
#include "base/tiles/tile_bytes.h"

typedef struct alpi_tile_head {
    uint32_t magic;
    uint32_t loop;     // its number in the bake
    uint64_t shape;    // alpi_tile_shape
    uint64_t size;     // of the packed tiles
    uint64_t checksum; // alpi_tile_checksum of the packed tiles
    uint64_t own;      // checksum of the fields above
} alpi_tile_head;

/// A record of an open log.
typedef struct alpi_tile_record {
    alpi_tile_head head;
    uint64_t offset; // of the packed tiles in the file
} alpi_tile_record;

typedef struct alpi_tile_log {
    alp_context *context;
    char *path; // owned
    int file;   // −1: closed
    bool writes;
    uint64_t key;
    uint64_t end; // bytes that are in order; 0: the head of the file is not written yet
    bool damaged; // bytes behind `end` were given up
    alpi_tile_record *records;
    size_t count, capacity;
} alpi_tile_log;

/// Opens a log and lists its records, up to the first damaged head.
/// @param key    of the bake; a log with another key counts as empty, and damaged
/// @param writes for appending: makes the file where missing, and cuts off damaged bytes
/// @return ALP_OK; IO (unreadable, or another process appends to it); OUT_OF_MEMORY
alp_result alpi_tile_log_open(alp_context *context, const char *path, uint64_t key, bool writes,
                              alpi_tile_log *log);
/// Locks an open file or folder until it is closed. A process that was killed may hold its lock for
/// a moment, so this waits for up to 2 seconds.
/// @param shared by others who share it   @return ALP_OK; IO (another process holds it)
alp_result alpi_tile_log_lock(alp_context *context, const char *path, int file, bool shared);
void alpi_tile_log_close(alpi_tile_log *log);

/// Reads the packed tiles of a record. @param bytes [head.size] out
/// @return false: unreadable, or the checksum is wrong
bool alpi_tile_log_read(const alpi_tile_log *log, const alpi_tile_record *record, uint8_t *bytes);

/// Fingerprint of bytes, eight at a time.
uint64_t alpi_tile_checksum(const uint8_t *bytes, size_t size);
/// Adds a record to bytes that are appended later. @param bytes from `start` on: room for the head,
/// then packed tiles
void alpi_tile_log_seal(uint32_t loop, uint64_t shape, size_t start, alpi_bytes *bytes);
/// Appends bytes of whole records and flushes them to the disk. On failure the file keeps its
/// former end. @return false: errno says why
bool alpi_tile_log_append(alpi_tile_log *log, const uint8_t *bytes, size_t size);

#endif
