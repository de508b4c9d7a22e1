// SPDX-License-Identifier: MIT
#include "test_ranks.h"

#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { LOOPS = 2, PATIENCE = 60 };

typedef struct test_job {
    const test_ranks_options *options;
    pthread_mutex_t lock;
    pthread_cond_t moved;
    uint64_t counters[LOOPS][TEST_RANKS_MOST];
    uint64_t claims;
    const void *sent[TEST_RANKS_MOST];
    size_t sizes[TEST_RANKS_MOST];
    uint32_t waiting;
    uint64_t barriers; // that all have passed
    bool gone;         // a rank left
} test_job;

typedef struct member {
    test_job *job;
    test_rank *rank;
    test_rank_fn *run;
    pthread_t thread;
    uint32_t calls;
    int left; // allocations of a starved rank
} member;

/// Waits for all. @return false: a rank is gone. Under the lock.
static bool meet(test_job *job)
{
    const uint64_t now = job->barriers;
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += PATIENCE;
    if (++job->waiting == job->options->count) {
        job->waiting = 0;
        job->barriers++;
        pthread_cond_broadcast(&job->moved);
    }
    while (job->barriers == now && !job->gone) {
        if (pthread_cond_timedwait(&job->moved, &job->lock, &until) == ETIMEDOUT) {
            fprintf(stderr, "a rank waits for others that do not come\n");
            abort();
        }
    }
    return job->barriers != now;
}

static uint64_t claim(void *user, uint64_t loop, uint32_t part, uint64_t amount)
{
    member *m = user;
    test_job *job = m->job;
    if (job->options->slow == m->rank->rank + 1) {
        nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
    }
    pthread_mutex_lock(&job->lock);
    const uint64_t before = job->counters[loop % LOOPS][part];
    job->counters[loop % LOOPS][part] += amount;
    job->claims++;
    pthread_mutex_unlock(&job->lock);
    return before;
}

static bool exchange(void *user, const void *bytes, size_t size, alp_receive_fn *receive,
                     void *receiver)
{
    member *m = user;
    test_job *job = m->job;
    const uint32_t own = m->rank->rank;
    bool good = true;
    pthread_mutex_lock(&job->lock);
    job->gone = job->gone || (job->options->leaves == own + 1 && m->calls == job->options->calls);
    pthread_cond_broadcast(&job->moved);
    job->sent[own] = bytes;
    job->sizes[own] = size;
    good = !job->gone && meet(job);
    if (good && own == 0) { // others cannot claim in the next loop before the second meeting
        memset(job->counters[(m->calls + 1) % LOOPS], 0, sizeof job->counters[0]);
    }
    m->calls++;
    pthread_mutex_unlock(&job->lock);
    for (uint32_t i = 0; i < job->options->count && good; i++) {
        good = i == own || receive(receiver, i, job->sent[i], job->sizes[i]);
    }
    pthread_mutex_lock(&job->lock);
    good = !job->gone && meet(job) && good;
    pthread_mutex_unlock(&job->lock);
    return good;
}

static void *allocate(void *user, size_t size)
{
    int *left = user;
    return *left > 0 ? (*left)--, malloc(size) : NULL;
}

static void release(void *user, void *block)
{
    (void)user;
    free(block);
}

static void *run_member(void *user)
{
    member *m = user;
    const test_ranks_options *o = m->job->options;
    const alp_ranks ranks = {.struct_size = sizeof ranks,
                             .rank = m->rank->rank,
                             .count = o->count,
                             .user = m,
                             .claim = claim,
                             .exchange = exchange};
    alp_context_options options = alp_context_options_default();
    options.worker_count = o->workers;
    options.ranks = &ranks;
    if (o->starved == m->rank->rank + 1) {
        m->left = o->allocations;
        options.worker_count = 1; // which counts alone
        options.allocate = allocate;
        options.release = release;
        options.allocator_user = &m->left;
    }
    m->rank->result = alp_context_create(&options, &m->rank->context);
    if (m->rank->result == ALP_OK) {
        m->run(m->rank);
        snprintf(m->rank->message, sizeof m->rank->message, "%s",
                 alp_context_message(m->rank->context));
        alp_context_destroy(m->rank->context);
    }
    return NULL;
}

uint64_t test_ranks_run(const test_ranks_options *options, test_rank_fn *run, test_rank *ranks)
{
    test_job job = {.options = options};
    member members[TEST_RANKS_MOST] = {{0}};
    pthread_mutex_init(&job.lock, NULL);
    pthread_cond_init(&job.moved, NULL);
    assert_true(options->count <= TEST_RANKS_MOST);
    for (uint32_t i = 0; i < options->count; i++) {
        const void *what = options->what[i] != NULL ? options->what[i] : options->what[0];
        ranks[i] = (test_rank){.rank = i, .count = options->count, .what = what};
        members[i] = (member){.job = &job, .rank = &ranks[i], .run = run};
        assert_int_equal(pthread_create(&members[i].thread, NULL, run_member, &members[i]), 0);
    }
    for (uint32_t i = 0; i < options->count; i++) {
        pthread_join(members[i].thread, NULL);
    }
    pthread_cond_destroy(&job.moved);
    pthread_mutex_destroy(&job.lock);
    return job.claims;
}
