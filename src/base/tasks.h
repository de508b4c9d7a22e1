// SPDX-License-Identifier: MIT
// Parallel loops over a pool of pthreads. Ranges are handed out one at a time (dynamic), as a
// static split of tiles over two threads was measured to gain nothing; but each worker has a part
// of them that it takes first. No OpenMP and no C11 threads: both fail under gcc's thread
// sanitizer.
#ifndef ALPI_BASE_TASKS_H
#define ALPI_BASE_TASKS_H

#include "base/context.h"

/// Body of a loop: works on [begin, end), a range of at most `grain`. After a failure no range
/// above it is begun, but those below it are, by the worker that failed too: what a worker keeps
/// from range to range must bear that.
typedef alp_result alpi_task_fn(void *user, uint32_t begin, uint32_t end, uint32_t worker);

/// What to tell the user while a loop runs. All may be NULL / 0.
typedef struct alpi_task_progress {
    alp_progress_fn *callback;
    void *user;
    const char *stage;
    double units_per_item; ///< progress counts items × this; 0 = 1
    double units_before;   ///< done by earlier loops of the same stage
    double units_total;    ///< of the whole stage; 0 = this loop alone
    double started;        ///< alpi_seconds() when the stage began; 0 = with this loop
    bool units_are_rays;   ///< then rays_per_second is reported
    bool silent;           ///< a short loop of a stage: reports 0 of 0, and may be cancelled
} alpi_task_progress;

/// Runs body over [0, count) in ranges of `grain` (> 0) on all workers of the context; returns when
/// all are done. The caller works too, as worker 0. A body must write only to what its own items
/// own, so the result does not depend on the number of workers.
/// @return ALP_OK; the failure of the lowest failing range; CANCELLED (progress said false).
alp_result alpi_parallel_for(alp_context *context, uint32_t count, uint32_t grain,
                             alpi_task_fn *body, void *user, const alpi_task_progress *progress);

/// For a body whose range takes long: tells the user where it is called by the thread that called
/// alpi_parallel_for, and says whether the loop still wants results; if not, return CANCELLED.
/// Outside of a loop: true.
bool alpi_loop_goes_on(alp_context *context);

enum { ALPI_SUM_LIMIT = 8 };
/// Adds items [begin, end) to sums that begin at 0.
typedef void alpi_sum_fn(const void *user, uint32_t begin, uint32_t end,
                         double sums[ALPI_SUM_LIMIT]);
/// Sums over [0, count) on all workers: of ranges that are always the same, added in their order,
/// so that any number of workers gives the same bits.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_parallel_sum(alp_context *context, uint32_t count, alpi_sum_fn *body,
                             const void *user, const alpi_task_progress *progress,
                             double sums[ALPI_SUM_LIMIT]);

/// Who is asked whether to go on while a call works on one thread alone.
typedef struct alpi_watch {
    alp_progress_fn *callback; // NULL: nobody
    void *user;
    double last; // alpi_seconds() when it was asked
} alpi_watch;

/// Sets who alpi_tick asks from now on and gives back who it was: a call that takes a progress
/// callback sets its own first and puts the former back last.
alpi_watch alpi_set_watch(alp_context *context, alpi_watch watch);

/// Says how far serial work is and asks whether to go on, at most 20 times a second; cheap enough
/// for every row or thousandth item. On the calling thread only.
/// @return ALP_OK; CANCELLED
alp_result alpi_tick(alp_context *context, const char *stage, uint64_t done, uint64_t total);

/// Seconds of a steady clock, for durations.
double alpi_seconds(void);

/// Used by the context only.
struct alpi_pool *alpi_pool_create(alp_context *context, uint32_t worker_count);
void alpi_pool_destroy(struct alpi_pool *pool);

#endif
