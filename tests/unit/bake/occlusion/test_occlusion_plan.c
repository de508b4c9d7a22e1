// SPDX-License-Identifier: MIT
// Rays of the next round: the error falls with the 0.7th power of the samples, so a round
// multiplies them by (1.05 × error / wanted error)^(1 / 0.7), rounded up to 2, 3, 4, 6, 8, …, 64.
#include "bake/occlusion/occlusion_plan.h"
#include "test_support.h"

#include <math.h>

enum { MOST = 1 << 20 };
static const alpi_occlusion_setup SETUP = {.samples = MOST};

static alpi_occlusion_task task_for(float error)
{
    return (alpi_occlusion_task){.setup = &SETUP, .error = error, .deadline = HUGE_VAL};
}

/// Samples after the next round of a map whose error is `over` times the wanted one after 64.
static uint32_t samples_after(double over, double p99_over)
{
    const alpi_occlusion_task task = task_for(0.01f);
    const double wanted = (double)task.error;
    const alpi_occlusion_report report = {
        .samples = 64, .relative = over * wanted, .p99 = 4.0 * p99_over * wanted};
    return alpi_occlusion_next_samples(&task, &report);
}

TEST(a_round_takes_the_rays_that_the_error_needs)
{
    // 2.1^(1/0.7) = 2.9, 4.2^(1/0.7) = 7.8, 10.5^(1/0.7) = 28.8
    assert_int_equal(samples_after(1.01, 0.0), 2 * 64);
    assert_int_equal(samples_after(2.0, 0.0), 3 * 64);
    assert_int_equal(samples_after(4.0, 0.0), 8 * 64);
    assert_int_equal(samples_after(10.0, 0.0), 32 * 64);
    assert_int_equal(samples_after(1000.0, 0.0), 64 * 64);
}

TEST(the_worst_hundredth_counts_like_the_mean)
{
    assert_int_equal(samples_after(1.0, 1.0), 0);
    assert_int_equal(samples_after(0.5, 4.0), 8 * 64);
    assert_int_equal(samples_after(4.0, 2.0), 8 * 64);
}

TEST(the_samples_of_the_setup_are_the_limit)
{
    const alpi_occlusion_task task = task_for(0.01f);
    alpi_occlusion_report report = {.samples = MOST / 2 + 4, .relative = 1.0, .p99 = 1.0};
    assert_int_equal(alpi_occlusion_next_samples(&task, &report), MOST);
    report.samples = MOST;
    assert_int_equal(alpi_occlusion_next_samples(&task, &report), 0);
}

TEST(rounds_need_an_error_or_a_deadline)
{
    const alpi_occlusion_report report = {.samples = 64, .relative = 1.0, .p99 = 1.0};
    alpi_occlusion_task task = task_for(0.0f);
    assert_int_equal(alpi_occlusion_first_samples(&task), MOST);
    assert_int_equal(alpi_occlusion_next_samples(&task, &report), 0);
    task.deadline = 1.0;
    assert_int_equal(alpi_occlusion_first_samples(&task), 64);
    assert_int_equal(alpi_occlusion_next_samples(&task, &report), 128);
    task = task_for(0.01f);
    assert_int_equal(alpi_occlusion_first_samples(&task), 64);
}
