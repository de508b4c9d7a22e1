// SPDX-License-Identifier: MIT
// Progress of the stages of an atlas, and their cancellation.
#include "atlas/stages.h"

#include "base/tasks.h"

alp_result alpi_atlas_tick(alpi_atlas_clock *clock, const char *stage, uint64_t done,
                           uint64_t total)
{
    if (clock->callback == NULL) {
        return ALP_OK;
    }
    double now = alpi_seconds();
    if (now - clock->last < 0.05) {
        return ALP_OK;
    }
    clock->last = now;
    alp_progress report = {.stage = stage, .done = done, .total = total, .seconds_left = -1.0};
    return clock->callback(clock->user, &report)
               ? ALP_OK
               : alpi_fail(clock->context, ALP_ERROR_CANCELLED, "cancelled");
}
