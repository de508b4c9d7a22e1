// SPDX-License-Identifier: MIT
#include "ranks/ranks_mpi.h"

#include <limits.h>
#include <mpi.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    LOOPS = 2,                // whose counters are kept: an exchange lies between two loops
    TOGETHER_BYTES = 1 << 28, // all ranks' bytes are gathered at once up to this
    PIECE = 1 << 30,          // bytes of a broadcast
    BUSY_TESTS = 200,         // before a wait sleeps
    SLEEP_LEAST = 20000,      // ns
    SLEEP_MOST = 500000       // ns
};
/// Seconds that a rank told to stop waits for others, which were told too. mpirun kills after 1 s.
static const double PATIENCE = 0.5;

typedef enum call_kind { CALL_EXCHANGE = 1, CALL_MEETING } call_kind;

/// Ranks gather this at the begin of every call.
typedef struct call_head {
    int32_t kind;  // call_kind
    int32_t value; // of a meeting
    uint64_t size; // bytes of an exchange
} call_head;

struct alpi_ranks_mpi {
    alp_ranks calls;
    MPI_Comm world;
    MPI_Win window;      // [LOOPS][count] counters on rank 0
    uint64_t *counters;  // of this process, NULL unless rank 0
    uint64_t exchanges;  // so far
    call_head *heads;    // [count] of the last call
    int *sizes, *places; // [count]
    bool (*stops)(void);
    bool broken;
};

// --- waiting -------------------------------------------------------------------------------------

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/// Waits for a collective call. @return false, and the job is broken: MPI failed, or this process
/// was told to stop and the others do not come
static bool wait_for(alpi_ranks_mpi *r, int started, MPI_Request *request)
{
    struct timespec pause = {.tv_nsec = SLEEP_LEAST};
    double until = 0.0;
    int done = 0;
    for (uint64_t tests = 0; started == MPI_SUCCESS; tests++) {
        if (MPI_Test(request, &done, MPI_STATUS_IGNORE) != MPI_SUCCESS) {
            break;
        }
        if (done) {
            return true;
        }
        if (tests < BUSY_TESTS) {
            continue;
        }
        if (r->stops != NULL && r->stops()) {
            until = until > 0.0 ? until : seconds_now() + PATIENCE;
            if (seconds_now() > until) {
                break;
            }
        }
        nanosleep(&pause, NULL);
        pause.tv_nsec = 2 * pause.tv_nsec < SLEEP_MOST ? 2 * pause.tv_nsec : SLEEP_MOST;
    }
    r->broken = true;
    return false;
}

// Requests end in wait_for. NOLINTBEGIN(clang-analyzer-optin.mpi.MPI-Checker)

/// Gathers the heads of a call. @return false: a rank is gone, or makes another call
static bool gather_heads(alpi_ranks_mpi *r, call_head own)
{
    MPI_Request request;
    if (r->broken) {
        return false;
    }
    const int started = MPI_Iallgather(&own, sizeof own, MPI_BYTE, r->heads, sizeof own, MPI_BYTE,
                                       r->world, &request);
    if (!wait_for(r, started, &request)) {
        return false;
    }
    for (uint32_t i = 0; i < r->calls.count; i++) {
        r->broken = r->broken || r->heads[i].kind != own.kind;
    }
    return !r->broken;
}

// --- claims --------------------------------------------------------------------------------------

static uint64_t change_counter(alpi_ranks_mpi *r, uint64_t loop, uint32_t part, uint64_t by,
                               MPI_Op how)
{
    uint64_t before = 0;
    const MPI_Aint place = (MPI_Aint)(loop % LOOPS * r->calls.count + part);
    if (r->broken ||
        MPI_Fetch_and_op(&by, &before, MPI_UINT64_T, 0, place, how, r->window) != MPI_SUCCESS ||
        MPI_Win_flush(0, r->window) != MPI_SUCCESS) {
        r->broken = true;
        return UINT64_MAX;
    }
    return before;
}

static uint64_t claim(void *user, uint64_t loop, uint32_t part, uint64_t amount)
{
    return change_counter(user, loop, part, amount, MPI_SUM);
}

/// Lets MPI answer the claims of others.
static void poll(void *user)
{
    const alpi_ranks_mpi *r = user;
    int there;
    (void)MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, r->world, &there, MPI_STATUS_IGNORE);
}

/// Clears the counters of the next loop. Its last use was before the exchange that came last.
static bool clear_next(alpi_ranks_mpi *r)
{
    bool good = true;
    for (uint32_t i = 0; i < r->calls.count && r->calls.rank == 0; i++) {
        good = change_counter(r, r->exchanges + 1, i, 0, MPI_REPLACE) != UINT64_MAX && good;
    }
    return good;
}

// --- exchanges -----------------------------------------------------------------------------------

/// Sends the bytes of one rank to all, in pieces that MPI can count.
static bool broadcast(alpi_ranks_mpi *r, uint32_t from, uint8_t *bytes, uint64_t size)
{
    for (uint64_t at = 0; at < size; at += PIECE) {
        MPI_Request request;
        const int count = (int)(size - at < PIECE ? size - at : PIECE);
        const int started = MPI_Ibcast(bytes + at, count, MPI_BYTE, (int)from, r->world, &request);
        if (!wait_for(r, started, &request)) {
            return false;
        }
    }
    return true;
}

/// Exchanges many bytes: those of one rank after the other.
static bool exchange_apart(alpi_ranks_mpi *r, const void *bytes, alp_receive_fn *receive,
                           void *receiver)
{
    bool good = true;
    for (uint32_t i = 0; i < r->calls.count && !r->broken; i++) {
        const uint64_t size = r->heads[i].size;
        uint8_t *room = malloc(size + 1);
        if (room == NULL) { // the others wait for this rank
            r->broken = true;
            return false;
        }
        if (i == r->calls.rank) {
            memcpy(room, bytes, size);
        }
        if (broadcast(r, i, room, size) && i != r->calls.rank) {
            good = receive(receiver, i, room, size) && good;
        }
        free(room);
    }
    return good && !r->broken;
}

/// Exchanges few bytes at once.
static bool exchange_together(alpi_ranks_mpi *r, const void *bytes, size_t size, size_t all,
                              alp_receive_fn *receive, void *receiver)
{
    uint8_t *room = malloc(all + 1);
    MPI_Request request;
    bool good = room != NULL;
    if (good) {
        for (uint32_t i = 0, at = 0; i < r->calls.count; i++) {
            r->sizes[i] = (int)r->heads[i].size;
            r->places[i] = (int)at;
            at += (uint32_t)r->sizes[i];
        }
        const int started = MPI_Iallgatherv(bytes, (int)size, MPI_BYTE, room, r->sizes, r->places,
                                            MPI_BYTE, r->world, &request);
        good = wait_for(r, started, &request);
    } else {
        r->broken = true;
    }
    for (uint32_t i = 0; i < r->calls.count && !r->broken; i++) {
        if (i != r->calls.rank) {
            good = receive(receiver, i, room + r->places[i], (size_t)r->sizes[i]) && good;
        }
    }
    free(room);
    return good;
}

static bool exchange(void *user, const void *bytes, size_t size, alp_receive_fn *receive,
                     void *receiver)
{
    alpi_ranks_mpi *r = user;
    const call_head own = {.kind = CALL_EXCHANGE, .size = size};
    if (r->broken || !clear_next(r) || !gather_heads(r, own)) {
        return false;
    }
    uint64_t all = 0;
    for (uint32_t i = 0; i < r->calls.count; i++) {
        all += r->heads[i].size;
    }
    r->exchanges++;
    return all <= TOGETHER_BYTES ? exchange_together(r, bytes, size, (size_t)all, receive, receiver)
                                 : exchange_apart(r, bytes, receive, receiver);
}

bool alpi_ranks_mpi_meet(alpi_ranks_mpi *ranks, int value, int *values)
{
    const bool good =
        gather_heads(ranks, (call_head){.kind = CALL_MEETING, .value = (int32_t)value});
    for (uint32_t i = 0; i < ranks->calls.count && good; i++) {
        values[i] = ranks->heads[i].value;
    }
    return good;
}

// --- the job -------------------------------------------------------------------------------------

/// Makes the counters, all 0.
static bool make_window(alpi_ranks_mpi *r)
{
    const uint32_t count = r->calls.rank == 0 ? LOOPS * r->calls.count : 0;
    const int size = sizeof *r->counters;
    if (MPI_Win_allocate((MPI_Aint)count * size, size, MPI_INFO_NULL, r->world, &r->counters,
                         &r->window) != MPI_SUCCESS) {
        return false;
    }
    MPI_Win_set_errhandler(r->window, MPI_ERRORS_RETURN);
    for (uint32_t i = 0; i < count; i++) {
        r->counters[i] = 0;
    }
    return MPI_Win_lock_all(0, r->window) == MPI_SUCCESS &&
           MPI_Win_sync(r->window) == MPI_SUCCESS && MPI_Barrier(r->world) == MPI_SUCCESS;
}

static void release(alpi_ranks_mpi *r)
{
    free(r->heads);
    free(r->sizes);
    free(r->places);
    free(r);
}

alpi_ranks_mpi *alpi_ranks_mpi_create(bool (*stops)(void))
{
    int rank, count;
    alpi_ranks_mpi *r = calloc(1, sizeof *r);
    if (r == NULL || MPI_Comm_dup(MPI_COMM_WORLD, &r->world) != MPI_SUCCESS) {
        free(r);
        return NULL;
    }
    MPI_Comm_set_errhandler(r->world, MPI_ERRORS_RETURN);
    MPI_Comm_rank(r->world, &rank);
    MPI_Comm_size(r->world, &count);
    r->stops = stops;
    r->calls = alp_ranks_default();
    r->calls.rank = (uint32_t)rank;
    r->calls.count = (uint32_t)count;
    r->calls.user = r;
    r->calls.claim = claim;
    r->calls.exchange = exchange;
    r->calls.poll = rank == 0 ? poll : NULL; // the counters are there
    r->heads = calloc((size_t)count, sizeof *r->heads);
    r->sizes = calloc((size_t)count, sizeof *r->sizes);
    r->places = calloc((size_t)count, sizeof *r->places);
    if (r->heads == NULL || r->sizes == NULL || r->places == NULL || !make_window(r)) {
        release(r);
        return NULL;
    }
    return r;
}

void alpi_ranks_mpi_destroy(alpi_ranks_mpi *ranks)
{
    if (!ranks->broken) {
        MPI_Win_unlock_all(ranks->window);
        MPI_Win_free(&ranks->window);
        MPI_Comm_free(&ranks->world);
    }
    release(ranks);
}

const alp_ranks *alpi_ranks_mpi_calls(const alpi_ranks_mpi *ranks)
{
    return &ranks->calls;
}

bool alpi_ranks_mpi_is_broken(const alpi_ranks_mpi *ranks)
{
    return ranks->broken;
}

// NOLINTEND(clang-analyzer-optin.mpi.MPI-Checker)
