// SPDX-License-Identifier: MIT
// A light propagation volume: its grids, and how its files share them.
#ifndef ALPI_FIELDS_LPV_H
#define ALPI_FIELDS_LPV_H

#include "base/vec.h"
#include "fields/propagation/lpv_grid.h"

struct alp_lpv {
    alp_context *context;
    alp_lpv_options options;
    uint32_t iterations;
    bool wraps;        // tests: light that leaves on one side enters on the other
    double eye[3];     // metres, of the last alp_lpv_follow; the centre before
    double forward[3]; // unit, or 0
    uint64_t skipped;
    uint32_t *places; // [place_limit] cell or node of each surfel that is being added
    size_t place_limit;
    alpi_lpv_grid grids[ALPI_LPV_CASCADES_MOST];
};

/// Centre of grid `cascade` before it is rounded to whole cells, in metres.
void alpi_lpv_ideal_centre(const alp_lpv *lpv, uint32_t cascade, double centre[3]);

#endif
