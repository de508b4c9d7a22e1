// SPDX-License-Identifier: MIT
// Ranks without MPI: threads of this program, each with a context of its own. Claims are counters
// under a lock, an exchange is two barriers about shared pointers.
#ifndef TEST_RANKS_H
#define TEST_RANKS_H

#include "test_support.h"

enum { TEST_RANKS_MOST = 8, TEST_RANKS_MESSAGE = 512 };

/// The work of one rank, and how it ended. It runs on a thread of its own and may not assert.
typedef struct test_rank {
    uint32_t rank, count;
    alp_context *context; // with these ranks
    const void *what;     // of the caller
    // Set by the rank:
    alp_result result;
    char message[TEST_RANKS_MESSAGE]; // of the context, copied after the run
    void *bytes;                      // malloc'ed, or NULL
    size_t size;
} test_rank;
typedef void test_rank_fn(test_rank *rank);

typedef struct test_ranks_options {
    uint32_t count, workers;
    uint32_t slow;   // 1 + the rank that sleeps at every claim; 0: none
    uint32_t leaves; // 1 + the rank that is gone after `calls` exchanges; 0: none
    uint32_t calls;
    uint32_t starved;                  // 1 + the rank with the allocator of `allocations`; 0: none
    int allocations;                   // that succeed
    const void *what[TEST_RANKS_MOST]; // of each rank; NULL: that of rank 0
} test_ranks_options;

/// Runs all ranks to their end; fails the test if they hang for a minute. `ranks` [count] out; the
/// caller frees their bytes.
/// @return claims made, of all ranks
uint64_t test_ranks_run(const test_ranks_options *options, test_rank_fn *run, test_rank *ranks);

#endif
