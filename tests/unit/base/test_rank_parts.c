// SPDX-License-Identifier: MIT
// The parts of a tile loop that ranks claim first: every tile is in one part, and parts are even,
// also where a block has less than one tile.
#include "base/tiles/rank_calls.h"
#include "base/tiles/tiles.h"

#include "test_support.h"

#include <math.h>
#include <stdlib.h>

/// A rank that gets its own part alone.
typedef struct own_rank {
    uint32_t rank;
    uint64_t next;
    uint8_t *runs; // [count of tiles] of all ranks
    uint32_t ran;  // tiles of this one
} own_rank;

static uint64_t claim(void *user, uint64_t loop, uint32_t part, uint64_t amount)
{
    own_rank *own = user;
    (void)loop;
    if (part != own->rank) {
        return UINT32_MAX; // others have claimed all
    }
    own->next += amount;
    return own->next - amount;
}

static bool exchange(void *user, const void *bytes, size_t size, alp_receive_fn *receive,
                     void *receiver)
{
    (void)user;
    (void)bytes;
    (void)size;
    (void)receive;
    (void)receiver;
    return true;
}

static alp_result count_run(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    own_rank *own = user;
    (void)worker;
    for (uint32_t i = begin; i < end; i++) {
        own->runs[i]++;
        own->ran++;
    }
    return ALP_OK;
}

/// Runs the part of a rank. @return its tiles
static uint32_t run_part(uint32_t rank, uint32_t ranks, uint32_t tiles, uint8_t *runs)
{
    own_rank own = {.rank = rank, .runs = runs};
    alp_ranks calls = alp_ranks_default();
    alp_context_options options = alp_context_options_default();
    alp_context *context = NULL;
    bool began = false;
    calls.rank = rank;
    calls.count = ranks;
    calls.user = &own;
    calls.claim = claim;
    calls.exchange = exchange;
    options.ranks = &calls;
    options.worker_count = 1;
    assert_int_equal(alp_context_create(&options, &context), ALP_OK);
    assert_int_equal(alpi_ranks_begin(context, "", &began), ALP_OK);
    assert_true(began);
    const alpi_tile_loop loop = {
        .name = "count", .count = tiles, .grain = 1, .body = count_run, .user = &own};
    // The tiles of the others never come, unless there are none.
    const alp_result result = alpi_tile_loop_run(context, &loop);
    assert_int_equal(result, own.ran == tiles ? ALP_OK : ALP_ERROR_IO);
    alp_context_destroy(context);
    return own.ran;
}

TEST(every_tile_is_in_one_even_part)
{
    static const uint32_t counts[] = {1, 7, 64, 127, 256, 271, 1280, 4096, 10007};
    static const uint32_t ranks[] = {2, 3, 4, 8, 128};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        for (size_t n = 0; n < sizeof ranks / sizeof *ranks; n++) {
            uint8_t *runs = calloc(counts[c], 1);
            uint32_t most = 0;
            assert_non_null(runs);
            for (uint32_t rank = 0; rank < ranks[n]; rank++) {
                const uint32_t ran = run_part(rank, ranks[n], counts[c], runs);
                most = ran > most ? ran : most;
            }
            for (uint32_t i = 0; i < counts[c]; i++) {
                assert_int_equal(runs[i], 1);
            }
            // If blocks have less than a tile, chance gives them: four standard deviations.
            const double share = (double)counts[c] / ranks[n];
            assert_true(most <= share + 4.0 * (sqrt(share) + 1.0));
            free(runs);
        }
    }
}
