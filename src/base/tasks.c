// SPDX-License-Identifier: MIT
// A pool of pthreads that share one loop at a time. Each begins with a part of its own of the
// ranges, and takes those of others when it has none left: loops over the same items then mostly
// find on their core what the loop before left there.
#include "base/tasks.h"

#include "base/memory.h"

#include <math.h>
#include <pthread.h>
#include <stdalign.h>
#include <stdatomic.h>
#include <time.h>

static const double PROGRESS_INTERVAL = 0.05; // seconds between two calls of a progress callback
// Seconds that a thread looks for the next loop, or for the end of this one, before it sleeps: to
// be woken takes as long, and work comes in many short loops one after the other.
static const double SPIN_LIMIT = 50e-6;

enum { PART_LIMIT = 64, CACHE_LINE = 64 };

/// A part of a loop's ranges, those from `next` to `end` − 1 being left.
typedef struct loop_part {
    alignas(CACHE_LINE) _Atomic uint64_t next; // all workers step past the end: 32 bits could wrap
    uint32_t end;
} loop_part;

/// One running loop. The body's failures are kept by range number, and ranges below one that failed
/// still run, so that the failure reported is the lowest whatever the order in which ranges ran.
typedef struct alpi_loop {
    loop_part parts[PART_LIMIT];
    alpi_task_fn *body;
    void *user;
    uint32_t count, grain;
    uint32_t part_count;
    _Atomic uint32_t limit; // items from here on are not worked on any more
    _Atomic bool stop;      // the user cancelled
    _Atomic uint32_t done;
    pthread_mutex_t lock; // guards the failure
    uint32_t failed_begin;
    alp_result failure;
    const alpi_task_progress *progress;
    pthread_t caller;
    double started, reported;
} loop;

struct alpi_pool {
    alp_context *context;
    pthread_mutex_t lock;
    pthread_cond_t wake, finished;
    loop *current;               // NULL between loops
    _Atomic uint64_t generation; // counts loops, so that a worker joins each once
    _Atomic uint32_t busy;       // workers inside the current loop
    _Atomic bool quit;
    uint32_t thread_count;
    struct pool_thread {
        struct alpi_pool *pool;
        pthread_t handle;
        uint32_t worker;
    } * threads;
};

double alpi_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

alpi_watch alpi_set_watch(alp_context *context, alpi_watch watch)
{
    alpi_watch former = *alpi_context_watch(context);
    *alpi_context_watch(context) = watch;
    return former;
}

alp_result alpi_tick(alp_context *context, const char *stage, uint64_t done, uint64_t total)
{
    alpi_watch *watch = alpi_context_watch(context);
    if (watch->callback == NULL) {
        return ALP_OK;
    }
    double now = alpi_seconds();
    if (now - watch->last < PROGRESS_INTERVAL) {
        return ALP_OK;
    }
    watch->last = now;
    alp_progress report = {.stage = stage, .done = done, .total = total, .seconds_left = -1.0};
    return watch->callback(watch->user, &report)
               ? ALP_OK
               : alpi_fail(context, ALP_ERROR_CANCELLED, "cancelled");
}

static void loop_fail(loop *l, uint32_t begin, alp_result failure)
{
    pthread_mutex_lock(&l->lock);
    if (l->failure == ALP_OK || begin < l->failed_begin) {
        l->failure = failure;
        l->failed_begin = begin;
        atomic_store_explicit(&l->limit, begin, memory_order_relaxed);
    }
    pthread_mutex_unlock(&l->lock);
}

/// On the calling thread only: tells the user, at most every PROGRESS_INTERVAL; nothing any more
/// once the loop was stopped, as who refused must not be asked again.
static void loop_report(loop *l, bool always)
{
    const alpi_task_progress *p = l->progress;
    double now = alpi_seconds();
    if (p == NULL || p->callback == NULL || (!always && now - l->reported < PROGRESS_INTERVAL) ||
        atomic_load_explicit(&l->stop, memory_order_relaxed)) {
        return;
    }
    l->reported = now;
    double per_item = p->units_per_item > 0.0 ? p->units_per_item : 1.0;
    double done =
        p->units_before + (double)atomic_load_explicit(&l->done, memory_order_relaxed) * per_item;
    double total = p->units_total > 0.0 ? p->units_total : (double)l->count * per_item;
    done = fmin(done, total); // the last item may be smaller
    double seconds = now - (p->started > 0.0 ? p->started : l->started);
    double rate = seconds > 0.0 ? done / seconds : 0.0;
    alp_progress report = {p->stage, (uint64_t)done, (uint64_t)total,
                           p->units_are_rays ? rate : 0.0,
                           rate > 0.0 ? (total - done) / rate : -1.0};
    if (p->silent) {
        report = (alp_progress){.stage = p->stage, .seconds_left = -1.0};
    }
    if (!p->callback(p->user, &report)) {
        loop_fail(l, UINT32_MAX, ALP_ERROR_CANCELLED);
        atomic_store_explicit(&l->stop, true, memory_order_relaxed);
    }
}

bool alpi_loop_goes_on(alp_context *context)
{
    loop *l = *alpi_context_loop(context);
    if (l == NULL) {
        return true;
    }
    if (pthread_equal(pthread_self(), l->caller)) {
        loop_report(l, false);
    }
    return !atomic_load_explicit(&l->stop, memory_order_relaxed);
}

static void loop_run_range(loop *l, uint32_t begin, uint32_t end, uint32_t worker)
{
    alp_result result = l->body(l->user, begin, end, worker);
    if (result != ALP_OK) {
        loop_fail(l, begin, result);
    }
    if (result == ALP_ERROR_CANCELLED) {
        atomic_store_explicit(&l->stop, true, memory_order_relaxed);
    }
    atomic_fetch_add_explicit(&l->done, end - begin, memory_order_relaxed);
}

/// Splits the ranges evenly, one part for each worker.
static void loop_split(loop *l, uint32_t workers)
{
    const uint32_t ranges = (l->count - 1) / l->grain + 1;
    l->part_count = workers < PART_LIMIT ? workers : PART_LIMIT;
    for (uint32_t i = 0; i < l->part_count; i++) {
        const uint64_t first = (uint64_t)ranges * i / l->part_count;
        const uint64_t end = (uint64_t)ranges * (i + 1) / l->part_count * l->grain;
        atomic_init(&l->parts[i].next, first * l->grain);
        l->parts[i].end = end < l->count ? (uint32_t)end : l->count;
    }
}

/// Works on what is left of a part.
static void loop_work_on(loop *l, loop_part *part, uint32_t worker)
{
    while (!atomic_load_explicit(&l->stop, memory_order_relaxed)) {
        uint64_t next = atomic_fetch_add_explicit(&part->next, l->grain, memory_order_relaxed);
        if (next >= part->end || next >= atomic_load_explicit(&l->limit, memory_order_relaxed)) {
            break;
        }
        uint32_t begin = (uint32_t)next;
        uint32_t end = part->end - begin < l->grain ? part->end : begin + l->grain;
        loop_run_range(l, begin, end, worker);
        if (pthread_equal(pthread_self(), l->caller)) {
            loop_report(l, false);
        }
    }
}

/// The worker's own part first, then what is left of the others.
static void loop_work(loop *l, uint32_t worker)
{
    for (uint32_t i = 0; i < l->part_count; i++) {
        loop_work_on(l, &l->parts[(worker + i) % l->part_count], worker);
    }
}

static void pause_briefly(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
}

/// Waits awake for a loop that was not seen yet.
static void look_for_loop(struct alpi_pool *pool, uint64_t seen)
{
    const double began = alpi_seconds();
    while (atomic_load_explicit(&pool->generation, memory_order_relaxed) == seen &&
           !atomic_load_explicit(&pool->quit, memory_order_relaxed) &&
           alpi_seconds() - began < SPIN_LIMIT) {
        pause_briefly();
    }
}

/// Waits awake for the others to end.
static void look_for_end(struct alpi_pool *pool)
{
    const double began = alpi_seconds();
    while (atomic_load_explicit(&pool->busy, memory_order_relaxed) > 0 &&
           alpi_seconds() - began < SPIN_LIMIT) {
        pause_briefly();
    }
}

static void *pool_thread_main(void *user)
{
    struct pool_thread *thread = user;
    struct alpi_pool *pool = thread->pool;
    uint64_t seen = 0;
    for (;;) {
        look_for_loop(pool, seen);
        pthread_mutex_lock(&pool->lock);
        while (!pool->quit && (pool->current == NULL || pool->generation == seen)) {
            pthread_cond_wait(&pool->wake, &pool->lock);
        }
        if (pool->quit) {
            pthread_mutex_unlock(&pool->lock);
            return NULL;
        }
        seen = pool->generation;
        loop *l = pool->current;
        pool->busy++;
        pthread_mutex_unlock(&pool->lock);
        loop_work(l, thread->worker);
        pthread_mutex_lock(&pool->lock);
        pool->busy--;
        pthread_cond_signal(&pool->finished);
        pthread_mutex_unlock(&pool->lock);
    }
}

struct alpi_pool *alpi_pool_create(alp_context *context, uint32_t worker_count)
{
    struct alpi_pool *pool = ALPI_NEW(context, struct alpi_pool, 1);
    struct pool_thread *threads = ALPI_NEW(context, struct pool_thread, worker_count);
    if (pool == NULL || threads == NULL) {
        alpi_release(context, pool);
        alpi_release(context, threads);
        return NULL;
    }
    *pool = (struct alpi_pool){.context = context, .threads = threads};
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pthread_condattr_t steady; // durations must not jump with the wall clock
    pthread_condattr_init(&steady);
    pthread_condattr_setclock(&steady, CLOCK_MONOTONIC);
    pthread_cond_init(&pool->finished, &steady);
    pthread_condattr_destroy(&steady);
    for (uint32_t i = 0; i + 1 < worker_count; i++) {
        threads[i] = (struct pool_thread){.pool = pool, .worker = i + 1};
        if (pthread_create(&threads[i].handle, NULL, pool_thread_main, &threads[i]) != 0) {
            break; // fewer threads change the time and nothing else
        }
        pool->thread_count = i + 1;
    }
    return pool;
}

void alpi_pool_destroy(struct alpi_pool *pool)
{
    if (pool == NULL) {
        return;
    }
    pthread_mutex_lock(&pool->lock);
    pool->quit = true;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    for (uint32_t i = 0; i < pool->thread_count; i++) {
        pthread_join(pool->threads[i].handle, NULL);
    }
    pthread_cond_destroy(&pool->finished);
    pthread_cond_destroy(&pool->wake);
    pthread_mutex_destroy(&pool->lock);
    alp_context *context = pool->context;
    alpi_release(context, pool->threads);
    alpi_release(context, pool);
}

/// Runs the loop on the pool and waits, reporting progress while others still work.
static void pool_run(struct alpi_pool *pool, loop *l)
{
    pthread_mutex_lock(&pool->lock);
    pool->current = l;
    pool->generation++;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    loop_work(l, 0);
    look_for_end(pool);
    pthread_mutex_lock(&pool->lock);
    pool->current = NULL; // a worker that wakes only now must not join
    while (pool->busy > 0) {
        struct timespec until;
        clock_gettime(CLOCK_MONOTONIC, &until);
        until.tv_nsec += (long)(PROGRESS_INTERVAL * 1e9);
        if (until.tv_nsec >= 1000000000L) {
            until.tv_sec += 1;
            until.tv_nsec -= 1000000000L;
        }
        pthread_cond_timedwait(&pool->finished, &pool->lock, &until);
        pthread_mutex_unlock(&pool->lock);
        loop_report(l, false);
        pthread_mutex_lock(&pool->lock);
    }
    pthread_mutex_unlock(&pool->lock);
}

/// Adapter for a host's scheduler, which knows neither failure nor progress. A host may pass ranges
/// longer than the grain: they are cut, so that cancelling stays prompt.
static void host_body(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    loop *l = user;
    while (begin < end && begin < atomic_load_explicit(&l->limit, memory_order_relaxed) &&
           !atomic_load_explicit(&l->stop, memory_order_relaxed)) {
        uint32_t stop = end - begin < l->grain ? end : begin + l->grain;
        loop_run_range(l, begin, stop, worker);
        if (pthread_equal(pthread_self(), l->caller)) {
            loop_report(l, false);
        }
        begin = stop;
    }
}

alp_result alpi_parallel_for(alp_context *context, uint32_t count, uint32_t grain,
                             alpi_task_fn *body, void *user, const alpi_task_progress *progress)
{
    if (count == 0) {
        return ALP_OK;
    }
    loop l = {.body = body,
              .user = user,
              .count = count,
              .grain = grain > 0 ? grain : 1,
              .limit = UINT32_MAX,
              .failed_begin = UINT32_MAX,
              .progress = progress,
              .caller = pthread_self(),
              .started = alpi_seconds()};
    pthread_mutex_init(&l.lock, NULL);
    loop **running = alpi_context_loop(context), *outer = *running;
    *running = &l;
    loop_report(&l, true);
    const alp_context_options *options = alpi_context_options(context);
    struct alpi_pool *pool = NULL;
    if (options->parallel_for != NULL) {
        options->parallel_for(options->parallel_user, count, l.grain, host_body, &l);
    } else if (count > l.grain && (pool = alpi_context_pool(context)) != NULL) {
        loop_split(&l, pool->thread_count + 1);
        pool_run(pool, &l);
    } else {
        loop_split(&l, 1);
        loop_work(&l, 0);
    }
    if (l.failure == ALP_OK) {
        loop_report(&l, true);
    }
    *running = outer;
    pthread_mutex_destroy(&l.lock);
    if (l.failure == ALP_ERROR_CANCELLED) {
        return alpi_fail(context, ALP_ERROR_CANCELLED, "cancelled");
    }
    return l.failure;
}

// --- sums ----------------------------------------------------------------------------------------

enum { ITEMS_PER_SUM = 1 << 10 };

typedef struct sum_job {
    alpi_sum_fn *body;
    const void *user;
    uint32_t count;
    double (*parts)[ALPI_SUM_LIMIT]; // [ranges]
} sum_job;

static alp_result sum_ranges(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const sum_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t first = i * ITEMS_PER_SUM, left = job->count - first;
        const uint32_t items = left < ITEMS_PER_SUM ? left : ITEMS_PER_SUM;
        job->body(job->user, first, first + items, job->parts[i]);
    }
    return ALP_OK;
}

alp_result alpi_parallel_sum(alp_context *context, uint32_t count, alpi_sum_fn *body,
                             const void *user, const alpi_task_progress *progress,
                             double sums[ALPI_SUM_LIMIT])
{
    const uint32_t ranges = count / ITEMS_PER_SUM + (count % ITEMS_PER_SUM != 0);
    sum_job job = {.body = body, .user = user, .count = count};
    job.parts = alpi_allocate(context, ranges, sizeof *job.parts);
    if (job.parts == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = alpi_parallel_for(context, ranges, 1, sum_ranges, &job, progress);
    for (int k = 0; k < ALPI_SUM_LIMIT; k++) {
        sums[k] = 0.0;
        for (uint32_t i = 0; i < ranges; i++) {
            sums[k] += job.parts[i][k];
        }
    }
    alpi_release(context, job.parts);
    return result;
}
