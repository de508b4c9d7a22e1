// SPDX-License-Identifier: MIT
// The occlusion of one map: what the files of this folder share.
#ifndef ALPI_BAKE_OCCLUSION_STATE_H
#define ALPI_BAKE_OCCLUSION_STATE_H

#include "bake/occlusion/occlusion_held_out.h"
#include "bake/occlusion/occlusion_progress.h"

typedef struct alpi_occlusion_state {
    const alpi_occlusion_task *task;
    alpi_occlusion_report *report;
    alpi_occlusion_clock clock;
    alpi_scratch *scratch;            // sums of the rays of traced texels
    uint8_t *marked;                  // [texels] to be traced next
    uint32_t *list;                   // [task->count] texels that are traced now, chart by chart
    alpi_chart_deal deal;             // of lists
    alpi_occlusion_held_out held_out; // measures the error
    uint32_t before;  // samples of a traced texel before this round; 0: this is the first
    uint32_t samples; // after it
} alpi_occlusion_state;

#endif
