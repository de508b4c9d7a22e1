// SPDX-License-Identifier: MIT
// One progress of all parts of light: loops that are weighed, and loops that are silent.
#include "bake/light/light_progress.h"

#include "base/tasks.h"
#include "test_support.h"

#include <unistd.h>

enum { STEPS = 10 };

typedef struct heard {
    alpi_light_clock clock;
    double left; // seconds
    uint64_t done;
} heard;

static bool listen(void *user, const alp_progress *progress)
{
    heard *h = user;
    h->left = progress->seconds_left;
    h->done = progress->done;
    return true;
}

static void start(heard *h)
{
    static alpi_bake_job job;
    const alpi_task_progress progress = {.callback = listen, .user = h, .stage = "light"};
    job = (alpi_bake_job){.options = alp_bake_options_default()};
    *h = (heard){.clock = alpi_light_clock_start(&job, &progress)};
}

/// @param done of STEPS   @return seconds left of the part, over those that it took
static double tell(heard *h, uint64_t done)
{
    usleep(20000);
    const alp_progress progress = {.stage = "light", .done = done, .total = STEPS};
    assert_true(alpi_light_clock_goes_on(&h->clock, &progress));
    return h->left / (alpi_seconds() - h->clock.part_began);
}

TEST(a_part_of_one_loop)
{
    heard h;
    start(&h);
    alpi_light_clock_part(&h.clock, true, 0.0);
    ASSERT_NEAR(tell(&h, 2), 4.0, 0.2); // 8 of 10 are left
    const uint64_t before = h.done;
    alpi_light_clock_part(&h.clock, true, 3.0); // the next part: three times as much follows
    ASSERT_NEAR(tell(&h, 5), 1.0 + 6.0, 0.3);
    assert_true(h.done >= before);
}

/// Loops that take .5, .3 and .2 of the time of their part.
TEST(loops_are_weighed)
{
    heard h;
    start(&h);
    alpi_light_clock_part(&h.clock, false, 0.0);
    alpi_light_clock_loop(&h.clock, 0.5);
    ASSERT_NEAR(tell(&h, 5), 3.0, 0.2); // .25 is done
    (void)tell(&h, STEPS);
    alpi_light_clock_loop(&h.clock, 0.6);
    ASSERT_NEAR(tell(&h, 5), 0.35 / 0.65, 0.05);
    (void)tell(&h, STEPS);
    alpi_light_clock_loop(&h.clock, 1.0);
    ASSERT_NEAR(tell(&h, 5), 0.1 / 0.9, 0.02);
    ASSERT_NEAR(tell(&h, STEPS), 0.0, 1e-9);
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
    heard h;
    start(&h);
    const alpi_task_progress silent = {
        .callback = alpi_light_clock_goes_on, .user = &h.clock, .stage = "light", .silent = true};
    alpi_light_clock_part(&h.clock, true, 0.0);
    ASSERT_OK(context, alpi_parallel_for(context, 100, 1, nothing, NULL, &silent));
    ASSERT_NEAR(tell(&h, 2), 4.0, 0.2);
    ASSERT_OK(context, alpi_parallel_for(context, 100, 1, nothing, NULL, &silent));
    ASSERT_NEAR(tell(&h, 4), 1.5, 0.1);
}
