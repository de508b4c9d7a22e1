// SPDX-License-Identifier: MIT
// Occlusion at the texels of an atlas: which texels are traced, with how many rays, and when it is
// good enough.
#ifndef ALPI_MAPS_OCCLUSION_MAP_H
#define ALPI_MAPS_OCCLUSION_MAP_H

#include "maps/lattice.h"
#include "transport/occlusion.h"

typedef struct alpi_occlusion_map_options {
    float accuracy; // 0: every texel is traced; −1: automatic; else see alp_sampling_options
    float error;    // wanted relative error; 0: the samples of the setup, once
    double time_limit;          // seconds from `started`, 0 = none
    double started;             // alpi_seconds()
    bool keep_partial;          // a cancelled bake ends with what it has
    alp_progress_fn *progress;
    void *progress_user;
} alpi_occlusion_map_options;

/// What came out, over the texels that were asked for.
typedef struct alpi_occlusion_map_report {
    uint64_t rays;
    uint64_t traced, interpolated;
    uint32_t samples;        // of each traced texel
    double mean;             // area-weighted
    double relative, p99;    // stated error, see physics
    bool cut_off;            // ended by the time limit or by cancelling
} alpi_occlusion_map_report;

/// Gathers the texels in `order` (a part of lattice->order) into lattice->values and states.
/// @param errors [texels] out: standard error of each, or NULL
alp_result alpi_occlusion_map(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              const uint32_t *order, uint32_t order_count,
                              const alpi_occlusion_map_options *options, alpi_lattice *lattice,
                              float *errors, alpi_occlusion_map_report *report);

#endif
