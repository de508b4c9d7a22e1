// SPDX-License-Identifier: MIT
// Parallel loops: every item once, failures and cancelling reported, any number of workers.
#include "test_support.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <stdatomic.h>
#include <unistd.h>

enum { ITEMS = 10007 };

static alp_result mark(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    unsigned char *seen = user;
    for (uint32_t i = begin; i < end; i++) {
        seen[i]++;
    }
    return ALP_OK;
}

TEST(every_item_runs_once)
{
    const uint32_t workers[] = {1, 2, 7, 32, 70}; // and more than there are parts of a loop
    for (size_t w = 0; w < sizeof workers / sizeof *workers; w++) {
        alp_context *context = test_context(workers[w]);
        for (int repeat = 0; repeat < 20; repeat++) {
            static unsigned char seen[ITEMS];
            memset(seen, 0, sizeof seen);
            ASSERT_OK(context, alpi_parallel_for(context, ITEMS, 13, mark, seen, NULL));
            for (int i = 0; i < ITEMS; i++) {
                assert_int_equal(seen[i], 1);
            }
        }
        alp_context_destroy(context);
    }
}

static alp_result fail_at_500_and_900(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    alp_context *context = user;
    if (begin <= 500 && 500 < end) {
        return alpi_fail(context, ALP_ERROR_LIMIT, "item 500");
    }
    return begin <= 900 && 900 < end ? ALP_ERROR_IO : ALP_OK;
}

TEST(a_failure_ends_the_loop)
{
    for (uint32_t workers = 1; workers <= 3; workers++) {
        alp_context *context = test_context(workers);
        alp_result result =
            alpi_parallel_for(context, ITEMS, 1, fail_at_500_and_900, context, NULL);
        assert_int_equal(result, ALP_ERROR_LIMIT);
        assert_string_equal(alp_context_message(context), "item 500");
        alp_context_destroy(context);
    }
}

typedef struct run_items {
    unsigned char seen[ITEMS];
    uint32_t failing;
} run_items;

static alp_result fail_at_one(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    run_items *run = user;
    mark(run->seen, begin, end, worker);
    return begin <= run->failing && run->failing < end ? ALP_ERROR_IO : ALP_OK;
}

/// All that is below a range that failed runs, whoever has it to do: one of it may fail too.
TEST(what_is_below_a_failure_still_runs)
{
    enum { GRAIN = 10 };
    for (uint32_t workers = 1; workers <= 4; workers++) {
        alp_context *context = test_context(workers);
        for (uint32_t failing = 0; failing < ITEMS; failing += 1250) {
            static run_items run;
            run = (run_items){.failing = failing};
            assert_int_equal(alpi_parallel_for(context, ITEMS, GRAIN, fail_at_one, &run, NULL),
                             ALP_ERROR_IO);
            for (uint32_t i = 0; i < ITEMS; i++) {
                assert_true(run.seen[i] == 1 || (run.seen[i] == 0 && i >= failing));
            }
        }
        alp_context_destroy(context);
    }
}

static alp_result count_items(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    atomic_fetch_add((_Atomic uint64_t *)user, end - begin);
    return ALP_OK;
}

TEST(as_many_items_as_there_are_numbers)
{
    for (uint32_t workers = 1; workers <= 3; workers++) {
        _Atomic uint64_t count = 0;
        alp_context *context = test_context(workers);
        ASSERT_OK(context,
                  alpi_parallel_for(context, UINT32_MAX, 3u << 28, count_items, &count, NULL));
        assert_true(count == UINT32_MAX);
        alp_context_destroy(context);
    }
}

static bool refuse(void *user, const alp_progress *progress)
{
    int *calls = user;
    assert_string_equal(progress->stage, "test");
    return ++*calls < 3;
}

static alp_result slow(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)user;
    (void)begin;
    (void)end;
    double until = alpi_seconds() + (worker == 0 ? 0.01 : 0.2); // others end after the caller
    while (alpi_seconds() < until) {
    }
    return ALP_OK;
}

static alp_result fail_slowly_at_first(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)user;
    (void)end;
    (void)worker;
    if (begin == 0) {
        usleep(30000);
        return ALP_ERROR_INVALID_DATA;
    }
    return ALP_ERROR_IO;
}

TEST(the_lowest_failure_is_the_one_told)
{
    const uint32_t workers[] = {1, 2, 7};
    for (int i = 0; i < 3; i++) {
        alp_context *context = test_context(workers[i]);
        for (int repeat = 0; repeat < 5; repeat++) { // range 0 always runs, and ends last
            assert_int_equal(alpi_parallel_for(context, 100, 1, fail_slowly_at_first, NULL, NULL),
                             ALP_ERROR_INVALID_DATA);
        }
        alp_context_destroy(context);
    }
}

typedef struct questions {
    int asked, answered_yes;
} questions;

static bool say_yes_a_few_times(void *user, const alp_progress *progress)
{
    questions *q = user;
    assert_string_equal(progress->stage, "serial");
    assert_int_equal(progress->total, 10);
    return q->asked++ < q->answered_yes;
}

TEST_WITH_CONTEXT(serial_work_can_be_cancelled, 1)
{
    questions q = {0, 1};
    assert_int_equal(alpi_tick(context, "serial", 0, 10), ALP_OK); // nobody to ask
    alpi_watch nobody = alpi_set_watch(context, (alpi_watch){say_yes_a_few_times, &q, 0.0});
    assert_null(nobody.callback);
    assert_int_equal(alpi_tick(context, "serial", 1, 10), ALP_OK);
    assert_int_equal(alpi_tick(context, "serial", 2, 10), ALP_OK); // too soon to ask again
    assert_int_equal(q.asked, 1);
    usleep(60000);
    assert_int_equal(alpi_tick(context, "serial", 3, 10), ALP_ERROR_CANCELLED);
    assert_int_equal(q.asked, 2);
    alpi_watch former = alpi_set_watch(context, nobody);
    assert_ptr_equal(former.user, &q);
    usleep(60000);
    assert_int_equal(alpi_tick(context, "serial", 4, 10), ALP_OK);
    assert_int_equal(q.asked, 2);
}

TEST(progress_can_cancel)
{
    for (uint32_t workers = 1; workers <= 3; workers++) {
        alp_context *context = test_context(workers);
        int calls = 0;
        alpi_task_progress progress = {.callback = refuse, .user = &calls, .stage = "test"};
        double started = alpi_seconds();
        alp_result result = alpi_parallel_for(context, 100000, 1, slow, NULL, &progress);
        assert_int_equal(result, ALP_ERROR_CANCELLED);
        assert_int_equal(calls, 3);
        assert_true(alpi_seconds() - started < 100.0); // of 1,000 seconds of work per worker
        alp_context_destroy(context);
    }
}

static bool stay_within(void *user, const alp_progress *progress)
{
    assert_true(progress->done <= progress->total);
    assert_int_equal(progress->total, 72);
    *(uint64_t *)user = progress->done;
    return true;
}

/// The last item of a stage may stand for fewer units than the others.
TEST_WITH_CONTEXT(progress_stays_within_its_total, 1)
{
    uint64_t done = 0;
    _Atomic uint64_t count = 0;
    const alpi_task_progress progress = {.callback = stay_within,
                                         .user = &done,
                                         .stage = "test",
                                         .units_per_item = 32.0,
                                         .units_total = 72.0};
    ASSERT_OK(context, alpi_parallel_for(context, 4, 1, count_items, &count, &progress));
    assert_int_equal(done, 72);
}

static void host_parallel_for(void *user, uint32_t count, uint32_t grain, alp_range_fn *body,
                              void *body_user)
{
    (void)grain;
    int *calls = user;
    ++*calls;
    body(body_user, 0, count / 2, 0); // ranges longer than the grain are allowed
    body(body_user, count / 2, count, 1);
}

TEST(a_host_scheduler_is_used)
{
    int calls = 0;
    alp_context_options options = alp_context_options_default();
    options.parallel_for = host_parallel_for;
    options.parallel_user = &calls;
    alp_context *context = NULL;
    assert_int_equal(alp_context_create(&options, &context), ALP_ERROR_INVALID_ARGUMENT);
    options.worker_count = 2;
    assert_int_equal(alp_context_create(&options, &context), ALP_OK);
    static unsigned char seen[ITEMS];
    memset(seen, 0, sizeof seen);
    ASSERT_OK(context, alpi_parallel_for(context, ITEMS, 13, mark, seen, NULL));
    assert_int_equal(calls, 1);
    for (int i = 0; i < ITEMS; i++) {
        assert_int_equal(seen[i], 1);
    }
    alp_context_destroy(context);
}

/// Numbers whose sum hangs on the order in which they are added.
static void add_items(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    (void)user;
    for (uint32_t i = begin; i < end; i++) {
        sums[0] += 1.0 / (1.0 + i);
        sums[1] += 1.0;
    }
}

TEST(sums_do_not_hang_on_the_workers)
{
    enum { COUNT = 100001 };
    double first = 0.0, exact = 0.0;
    for (uint32_t i = COUNT; i > 0; i--) {
        exact += 1.0 / i;
    }
    for (uint32_t workers = 1; workers <= 7; workers += 3) {
        alp_context *context = test_context(workers);
        double sums[ALPI_SUM_LIMIT];
        ASSERT_OK(context, alpi_parallel_sum(context, COUNT, add_items, NULL, NULL, sums));
        first = workers == 1 ? sums[0] : first;
        assert_true(sums[0] == first && sums[1] == (double)COUNT && sums[2] == 0.0);
        ASSERT_NEAR(sums[0], exact, 1e-12); // rounding of some thousand sums in a range
        ASSERT_OK(context, alpi_parallel_sum(context, 0, add_items, NULL, NULL, sums));
        assert_true(sums[0] == 0.0);
        alp_context_destroy(context);
    }
}

TEST_WITH_CONTEXT(no_items_is_no_work, 2)
{
    ASSERT_OK(context, alpi_parallel_for(context, 0, 1, mark, NULL, NULL));
}
