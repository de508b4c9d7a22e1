// SPDX-License-Identifier: MIT
// Occlusion at the texels of an atlas: which are traced, with how many rays, when it is good
// enough, and how far it is from the truth.
#ifndef ALPI_MAPS_OCCLUSION_MAP_H
#define ALPI_MAPS_OCCLUSION_MAP_H

#include "maps/texels/lattice.h"
#include "maps/texels/scratch.h"
#include "transport/occlusion/occlusion.h"

#include <alpenglow/lightmap.h>

/// When to stop, and what may be interpolated. See alp_sampling_options.
typedef struct alpi_occlusion_map_options {
    const uint8_t *near;   // [texels] alpi_proximity, or NULL
    float accuracy;        // ALP_ADAPTIVE_OFF, ALP_ADAPTIVE_AUTO, or in (0, 1)
    float error;           // wanted relative error; 0: all samples of the setup, in one round
    double deadline;       // in alpi_seconds(), HUGE_VAL = none
    bool keep_partial;     // cancelled by the user: ends with what there is
    float (*bent)[3];      // [texels] out: bent normals of those in `order`; or NULL
    alpi_scratch *scratch; // [texels] zero for those in `order`, not so after; NULL: makes its own
    alp_progress_fn *progress;
    void *progress_user;
} alpi_occlusion_map_options;

typedef struct alpi_occlusion_map_report {
    uint64_t rays, traced, interpolated, unknown; // texels; unknown: cut off before its turn
    uint32_t samples;                             // of a traced texel
    // Stated error over the mean: √ mean of squares, and 99th percentile, of the last round that
    // ended; NaN when none did.
    double relative, p99;
    bool cut_off; // by the deadline or the user
} alpi_occlusion_map_report;

/// Gathers the texels in `order` (some of lattice->order, in its order) into lattice->values and
/// ->states. With `error`, rounds of more and more samples until the stated error is reached, or
/// the setup's samples are spent. Bent normals need setup->bent.
/// @param errors [texels] out: standard error of each
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_occlusion_map(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              const uint32_t *order, uint32_t order_count,
                              const alpi_occlusion_map_options *options, alpi_lattice *lattice,
                              float *errors, alpi_occlusion_map_report *report);

#endif
