// SPDX-License-Identifier: MIT
// The frames of alpenglow lpv as table and JSON.
#ifndef COMMAND_LPV_REPORT_H
#define COMMAND_LPV_REPORT_H

#include "lpv/lpv_run.h"

#include <jansson.h>

/// trace, inject, block, propagate, and the whole frame by the clock
enum { LPV_STAGES = 5 };

typedef struct lpv_record {
    uint32_t count;                   // frames
    double sun_turn;                  // radians a frame
    double *milliseconds[LPV_STAGES]; // [count]
    alp_lpv_report last;              // of the last frame
} lpv_record;

/// Sorts the times of each stage. The functions below need it.
void lpv_record_sort(lpv_record *record);
void lpv_print(const lpv_run *run, const lpv_record *record);
/// The document, or NULL when memory ran out. The caller releases it.
json_t *lpv_json(const lpv_run *run, const command_line *arguments, const lpv_record *record);

#endif
