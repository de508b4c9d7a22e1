// SPDX-License-Identifier: MIT
// Several processes that do the work of one. A host gives a context two calls between processes;
// loops that trace rays are then shared out, and every process ends with all results.
#ifndef ALPENGLOW_RANKS_H
#define ALPENGLOW_RANKS_H

#include <alpenglow/result.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

ALP_BEGIN_DECLS

/// Receives the bytes of another rank; they are valid during the call only.
/// @return false: the bytes are wrong, and the exchange fails
typedef bool alp_receive_fn(void *receiver, uint32_t rank, const void *bytes, size_t size);

/// The processes that work together, and this one's place among them. All of them make the same
/// calls with the same scene and options, in the same order. All calls run on the thread that
/// called the library.
typedef struct alp_ranks {
    size_t struct_size; ///< set by the default
    uint32_t rank;      ///< of this process, in [0, count)
    uint32_t count;     ///< of processes, at least 1
    void *user;         ///< of the calls

    /// Adds `amount` to a counter that all ranks share. Counters begin at 0. A counter is a pair
    /// (loop, part): `loop` is the number of exchanges so far, `part` is in [0, count).
    /// @return the value before; UINT64_MAX: the call failed
    uint64_t (*claim)(void *user, uint64_t loop, uint32_t part, uint64_t amount);

    /// Sends bytes to all others and receives theirs, in the order of ranks. Returns when all have
    /// called it.
    /// @return false: a rank is gone, or receive returned false
    bool (*exchange)(void *user, const void *bytes, size_t size, alp_receive_fn *receive,
                     void *receiver);

    /// Called between tiles, so that a host can answer claims of others; NULL: not needed.
    void (*poll)(void *user);
} alp_ranks;

/// No ranks: one process.
ALP_API alp_ranks alp_ranks_default(void);

ALP_END_DECLS

#endif
