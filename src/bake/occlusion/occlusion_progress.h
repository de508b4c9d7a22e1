// SPDX-License-Identifier: MIT
// Progress of occlusion, the deadline, and loops over the texels of a task.
#ifndef ALPI_BAKE_OCCLUSION_PROGRESS_H
#define ALPI_BAKE_OCCLUSION_PROGRESS_H

#include "bake/occlusion/occlusion_rounds.h"

/// Progress, the deadline, and whether the user cancels.
typedef struct alpi_occlusion_clock {
    const alpi_occlusion_task *task; // its callback, deadline and keep_partial
    double started;                  // alpi_seconds()
    alp_progress last;               // report to the user
    double last_time;                // of it, alpi_seconds()
    bool cancelled;                  // by the user
} alpi_occlusion_clock;

alpi_occlusion_clock alpi_occlusion_clock_start(const alpi_occlusion_task *task);
/// Progress of loops that trace rays. They end when the user cancels or the deadline passes.
alpi_task_progress alpi_occlusion_progress_of_rays(alpi_occlusion_clock *clock);
/// Progress of short loops over texels, useless unless complete. They ignore the deadline, and with
/// keep_partial the user too.
alpi_task_progress alpi_occlusion_progress_of_texels(alpi_occlusion_clock *clock);
/// Reports from a serial loop. @return ALP_OK; CANCELLED
alp_result alpi_occlusion_tick(alpi_occlusion_clock *clock);

/// Loops over the texels of the task, with the progress of texels.
alp_result alpi_occlusion_for_texels(alpi_occlusion_clock *clock, alpi_task_fn *body, void *user);
alp_result alpi_occlusion_sum_texels(alpi_occlusion_clock *clock, alpi_sum_fn *body,
                                     const void *user, double sums[ALPI_SUM_LIMIT]);

#endif
