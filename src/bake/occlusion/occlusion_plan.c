// SPDX-License-Identifier: MIT
// How many rays the next round of occlusion takes.
#include "bake/occlusion/occlusion_plan.h"

#include "maps/texels/relative_error.h"

#include <math.h>

enum { FIRST_SAMPLES = 64, MOST_TIMES = 64 };
// The error of these sequences falls with about this power of the samples.
static const double ERROR_POWER = 0.7;
// Aims below the wanted error: a few rays more cost less than another round.
static const double MARGIN = 1.05;

static bool takes_rounds(const alpi_occlusion_task *task)
{
    return task->error > 0.0f || task->deadline < HUGE_VAL;
}

uint32_t alpi_occlusion_first_samples(const alpi_occlusion_task *task)
{
    const uint32_t most = task->setup->samples;
    return takes_rounds(task) && most > FIRST_SAMPLES ? FIRST_SAMPLES : most;
}

/// Multiple of the samples so far that reaches the wanted error: 2, 3, 4, 6, 8 …
static uint32_t next_factor(const alpi_occlusion_report *report, double wanted)
{
    const double over = fmax(report->relative / wanted, report->p99 / (ALPI_P99_LIMIT * wanted));
    const double needed = pow(MARGIN * over, 1.0 / ERROR_POWER);
    uint32_t factor = 2;
    while (factor < needed && factor < MOST_TIMES) {
        factor = factor % 3 == 0 ? factor / 3 * 4 : factor / 2 * 3;
    }
    return factor;
}

uint32_t alpi_occlusion_next_samples(const alpi_occlusion_task *task,
                                     const alpi_occlusion_report *report)
{
    const double wanted = (double)task->error;
    const uint32_t most = task->setup->samples;
    const bool good = report->relative <= wanted && report->p99 <= ALPI_P99_LIMIT * wanted;
    if (!takes_rounds(task) || good || report->samples == most) {
        return 0;
    }
    const uint32_t factor = wanted > 0.0 ? next_factor(report, wanted) : 2;
    return factor < most / report->samples ? factor * report->samples : most;
}
