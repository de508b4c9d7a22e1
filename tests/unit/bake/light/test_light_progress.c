// SPDX-License-Identifier: MIT
// One progress of all parts of light: loops that are weighed, and loops that are silent.
#include "bake/light/light_progress.h"

#include "base/tasks.h"
#include "test_support.h"

enum { STEPS = 10 };

typedef struct bake_clock {
    alpi_light_clock clock;
    double left;   // reported seconds
    uint64_t done; // reported progress
} bake_clock;

static bool receive(void *user, const alp_progress *progress)
{
    bake_clock *b = user;
    b->left = progress->seconds_left;
    b->done = progress->done;
    return true;
}

static void start(bake_clock *b)
{
    static alpi_bake_job job;
    const alpi_task_progress progress = {.callback = receive, .user = b, .stage = "light"};
    job = (alpi_bake_job){.options = alp_bake_options_default()};
    *b = (bake_clock){.clock = alpi_light_clock_start(&job, &progress)};
}

/// Reports `done` of STEPS. The part then took t seconds, and has `expected` times t left.
static void report(bake_clock *b, uint64_t done, double expected)
{
    const alp_progress progress = {.stage = "light", .done = done, .total = STEPS};
    const double before = alpi_seconds() - b->clock.part_began;
    assert_true(alpi_light_clock_goes_on(&b->clock, &progress));
    const double after = alpi_seconds() - b->clock.part_began;
    assert_true(b->left >= (1.0 - 1e-9) * expected * before);
    assert_true(b->left <= (1.0 + 1e-9) * expected * after + 1e-12);
}

TEST(a_part_of_one_loop)
{
    bake_clock b;
    start(&b);
    alpi_light_clock_part(&b.clock, true, 0.0);
    report(&b, 2, 4.0); // 8 of 10 are left
    const uint64_t before = b.done;
    alpi_light_clock_part(&b.clock, true, 3.0); // the next part: three times as much follows
    report(&b, 5, 1.0 + 6.0);
    assert_true(b.done >= before);
}

/// Loops that take .5, .3 and .2 of the time of their part.
TEST(loops_are_weighed)
{
    bake_clock b;
    start(&b);
    alpi_light_clock_part(&b.clock, false, 0.0);
    alpi_light_clock_loop(&b.clock, 0.5);
    report(&b, 5, 3.0); // .25 is done
    report(&b, STEPS, 1.0);
    alpi_light_clock_loop(&b.clock, 0.6);
    report(&b, 5, 0.35 / 0.65);
    report(&b, STEPS, 0.25);
    alpi_light_clock_loop(&b.clock, 1.0);
    report(&b, 5, 0.1 / 0.9);
    report(&b, STEPS, 0.0);
}

static alp_result nothing(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)user;
    (void)begin;
    (void)end;
    (void)worker;
    return ALP_OK;
}

/// A short loop within a part, such as the choice of texels, does not end it.
TEST_WITH_CONTEXT(silent_loops_take_no_share, 1)
{
    bake_clock b;
    start(&b);
    const alpi_task_progress silent = {
        .callback = alpi_light_clock_goes_on, .user = &b.clock, .stage = "light", .silent = true};
    alpi_light_clock_part(&b.clock, true, 0.0);
    ASSERT_OK(context, alpi_parallel_for(context, 100, 1, nothing, NULL, &silent));
    report(&b, 2, 4.0);
    ASSERT_OK(context, alpi_parallel_for(context, 100, 1, nothing, NULL, &silent));
    report(&b, 4, 1.5);
}
