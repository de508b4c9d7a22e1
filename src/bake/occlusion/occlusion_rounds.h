// SPDX-License-Identifier: MIT
// Occlusion at the texels of an atlas, in rounds of more and more rays until the stated error is
// small enough.
#ifndef ALPI_BAKE_OCCLUSION_ROUNDS_H
#define ALPI_BAKE_OCCLUSION_ROUNDS_H

#include "maps/texels/lattice.h"
#include "maps/texels/scratch.h"
#include "transport/occlusion/occlusion.h"

#include <alpenglow/lightmap.h>

/// Texels to gather, and when to stop. See alp_sampling_options.
typedef struct alpi_occlusion_task {
    const alpi_occlusion_setup *setup; // bent normals need setup->bent
    const alpi_receivers *receivers;   // texels of the atlas
    const uint32_t *order;             // [count] texels to gather, a subsequence of lattice->order
    uint32_t count;
    const uint8_t *proximity; // [texels] alpi_proximity, or NULL: all are far
    alpi_lattice *lattice;    // values and states of the texels in `order`: out
    float *errors;            // [texels] standard error of those in `order`: out
    float (*bent)[3];         // [texels] bent normals of those in `order`: out; or NULL
    alpi_scratch *scratch;    // [texels] zero for those in `order`, not so after
    float accuracy;           // ALP_ADAPTIVE_OFF, ALP_ADAPTIVE_AUTO, or in (0, 1)
    float error;              // wanted relative error; 0: all samples of the setup
    double deadline;          // in alpi_seconds(), HUGE_VAL = none
    bool keep_partial;        // a bake that the user cancels keeps the values it has
    alp_progress_fn *progress;
    void *progress_user;
} alpi_occlusion_task;

typedef struct alpi_occlusion_report {
    uint64_t rays, traced, interpolated, unknown; // texels; unknown: cut off before their turn
    uint32_t samples;                             // of a traced texel
    // Stated error over the mean after the last complete round: root mean square and 99th
    // percentile. NaN before the first.
    double relative, p99;
    bool cut_off; // by the deadline or the user
} alpi_occlusion_report;

/// Gathers the texels of a task. With a wanted error or a deadline it takes rounds; otherwise all
/// samples of the setup are one round.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED; LIMIT: the deadline came before any texel had a value
alp_result alpi_occlusion_rounds(const alpi_occlusion_task *task, alpi_occlusion_report *report);

#endif
