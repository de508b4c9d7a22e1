// SPDX-License-Identifier: MIT
// Progress of occlusion, its deadline, and whether the user cancels; loops over the texels of a
// task.
#include "bake/occlusion/occlusion_progress.h"

enum { TEXELS_PER_RANGE = 1 << 12 };

alpi_occlusion_clock alpi_occlusion_clock_start(const alpi_occlusion_task *task)
{
    const double now = alpi_seconds();
    return (alpi_occlusion_clock){.task = task,
                                  .started = now,
                                  .last = {.stage = "occlusion", .seconds_left = -1.0},
                                  .last_time = now};
}

/// An alp_progress_fn whose user is the clock.
static bool report_rays(void *user, const alp_progress *progress)
{
    alpi_occlusion_clock *clock = user;
    const alpi_occlusion_task *task = clock->task;
    clock->last = *progress;
    clock->last_time = alpi_seconds();
    if (task->progress != NULL && !task->progress(task->progress_user, progress)) {
        clock->cancelled = true;
    }
    return !clock->cancelled && alpi_seconds() < task->deadline;
}

/// Repeats the last report of rays, at most 20 times a second.
static bool report_texels(void *user, const alp_progress *progress)
{
    const double interval = 0.05; // seconds
    alpi_occlusion_clock *clock = user;
    (void)progress;
    if (clock->task->keep_partial || alpi_seconds() - clock->last_time < interval) {
        return true;
    }
    const alp_progress last = clock->last;
    (void)report_rays(clock, &last);
    return !clock->cancelled;
}

alpi_task_progress alpi_occlusion_progress_of_rays(alpi_occlusion_clock *clock)
{
    return (alpi_task_progress){.callback = report_rays, .user = clock, .stage = "occlusion"};
}

alpi_task_progress alpi_occlusion_progress_of_texels(alpi_occlusion_clock *clock)
{
    return (alpi_task_progress){.callback = report_texels, .user = clock, .stage = "occlusion"};
}

alp_result alpi_occlusion_tick(alpi_occlusion_clock *clock)
{
    const alp_result result =
        alpi_tick(clock->task->setup->context, "occlusion", clock->last.done, clock->last.total);
    clock->cancelled = clock->cancelled || result == ALP_ERROR_CANCELLED;
    return result;
}

// --- loops over the texels of the task -----------------------------------------------------------

alp_result alpi_occlusion_for_texels(alpi_occlusion_clock *clock, alpi_task_fn *body, void *user)
{
    const alpi_task_progress progress = alpi_occlusion_progress_of_texels(clock);
    return alpi_parallel_for(clock->task->setup->context, clock->task->count, TEXELS_PER_RANGE,
                             body, user, &progress);
}

alp_result alpi_occlusion_sum_texels(alpi_occlusion_clock *clock, alpi_sum_fn *body,
                                     const void *user, double sums[ALPI_SUM_LIMIT])
{
    const alpi_task_progress progress = alpi_occlusion_progress_of_texels(clock);
    return alpi_parallel_sum(clock->task->setup->context, clock->task->count, body, user, &progress,
                             sums);
}
