// SPDX-License-Identifier: MIT
// Calls between ranks. Ranks begin work together and end it together; between the two, tile loops
// are shared out. Every call carries the sender's result, so that a rank that fails anywhere ends
// the work of all at their next call.
#ifndef ALPI_BASE_RANK_CALLS_H
#define ALPI_BASE_RANK_CALLS_H

#include "base/context.h"

enum { ALPI_RANK_TEXT = 256 };

/// Stands before the bytes of a call.
typedef struct alpi_rank_head {
    uint64_t shape;            // of the loop, or of the beginning or the end
    uint32_t number;           // of the loop
    int32_t result;            // alp_result of the sender; unless OK, no bytes follow
    char text[ALPI_RANK_TEXT]; // message of a failure
} alpi_rank_head;

/// Takes the bytes of another rank. @return false: they are damaged
typedef bool alpi_rank_take_fn(void *user, uint32_t rank, const uint8_t *bytes, size_t size);

typedef struct alpi_rank_call {
    uint64_t shape;
    uint32_t number;
    alp_result result; // of this rank so far; its message is the context's
    uint8_t *bytes;    // [size] first room for an alpi_rank_head; NULL: nothing is sent
    size_t size;
    alpi_rank_take_fn *take;
    void *user;
} alpi_rank_call;

/// Exchanges bytes with all ranks. After a failure that all ranks know, this one works alone.
/// @return ALP_OK; the own result; the result of the lowest rank that failed; IO (a rank is gone,
///         its bytes are damaged, or it makes another call)
alp_result alpi_rank_exchange(alp_context *context, const alpi_rank_call *call);

/// Begins work of all ranks, if there are several and none began yet.
/// @param settings lines "name value", which must be the same in all ranks
/// @param began out: alpi_ranks_end must follow
/// @return ALP_OK; IO (a rank is gone, or has other settings); OUT_OF_MEMORY
alp_result alpi_ranks_begin(alp_context *context, const char *settings, bool *began);
/// Replaces a value by the lowest of all ranks, so that they choose alike by it. Every rank makes
/// this call. Without ranks that work together the value stays.
/// @return as alpi_rank_exchange
alp_result alpi_ranks_lowest(alp_context *context, uint64_t *value);
/// Ends it, and lets all ranks know whether this one failed.
/// @return the own result; else that of another rank, as in alpi_rank_exchange
alp_result alpi_ranks_end(alp_context *context, alp_result result);

/// The ranks that share loops now; NULL: this process works alone.
const alp_ranks *alpi_ranks_now(alp_context *context);
/// Whether this process writes files: rank 0 does.
bool alpi_ranks_write(const alp_context *context);

#endif
