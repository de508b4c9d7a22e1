// SPDX-License-Identifier: MIT
// A small bake of everything, from each kind of file, of which anything may be made to fail; and a
// look at what then lies in its folder.
#ifndef TEST_SMALL_BAKE_H
#define TEST_SMALL_BAKE_H

#include "test_support.h"

#include <stdatomic.h>

/// The allocations of a context, of which one fails.
typedef struct test_memory {
    atomic_long count, live; // asked for so far; not given back yet
    long failing;            // the number of the one that fails, from 0; −1: none
    bool backwards;          // loops run by a host that takes the last range first: after a failure
                             // all those below it follow
} test_memory;

/// A silent context whose memory is counted there.
alp_context *test_memory_context(test_memory *memory, uint32_t workers);

enum { TEST_SMALL_BAKE_KINDS = 6, TEST_SMALL_BAKE_FILES = 16 };

/// One kind of file in and out.
typedef struct test_small_bake {
    const char *kind; // ".dae -> .dae"
    alp_lightmap_as as;
    alp_maps_format format;
    char scene[512], output[512], maps[512];     // paths
    char folder[512];                            // of the outputs
    uint64_t memory_limit;                       // of the bake, bytes; 0: none
    uint32_t file_count;                         // files that it makes, once it has run
    char *files[TEST_SMALL_BAKE_FILES];          // malloc'ed
    unsigned char *bytes[TEST_SMALL_BAKE_FILES]; // what they hold, malloc'ed
    size_t sizes[TEST_SMALL_BAKE_FILES];
} test_small_bake;

/// Writes the scene and its pictures to a new folder, bakes it and keeps what came of it; then puts
/// "precious" into each of these files.
test_small_bake test_small_bake_open(int kind);
void test_small_bake_close(test_small_bake *bake);

/// Loads, bakes occlusion and light into an asset and a folder of maps, overwriting.
alp_result test_small_bake_run(const test_small_bake *bake, alp_context *context);

/// Of its files: which are old ("precious"), new (as the undisturbed bake had made them), neither,
/// or not there; and files that it does not make.
typedef struct test_small_bake_state {
    uint32_t old, new, neither, missing, others;
} test_small_bake_state;
test_small_bake_state test_small_bake_look(const test_small_bake *bake);
/// Puts "precious" into each again.
void test_small_bake_reset(const test_small_bake *bake);
/// Removes them and the folder of the maps.
void test_small_bake_clear(const test_small_bake *bake);

#endif
