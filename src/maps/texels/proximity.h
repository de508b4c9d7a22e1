// SPDX-License-Identifier: MIT
// How near other surfaces are to texels, by short rays of occlusion.
#ifndef ALPI_MAPS_PROXIMITY_H
#define ALPI_MAPS_PROXIMITY_H

#include "maps/texels/lattice.h"
#include "maps/texels/scratch.h"

/// How far another surface is from a texel.
typedef enum alpi_proximity {
    ALPI_FAR = 0,
    ALPI_NEAR,    // within some texels: interpolate with care
    ALPI_TOUCHING // within about one: light may change inside a texel
} alpi_proximity;

typedef struct alpi_proximity_job {
    const alpi_occlusion_setup *setup; // its scene and tracer
    const alpi_receivers *receivers;   // texels of the lattice
    const alpi_lattice *lattice;
    const uint32_t *order; // [count]
    uint32_t count;
    alpi_scratch *scratch; // sums and marks: zero for these texels before, not so after
    uint8_t *proximity;    // [texels] alpi_proximity of those in the order: out
    uint64_t rays;         // traced: out
} alpi_proximity_job;

/// Finds the proximity of the texels in the order. Every second texel of every second row traces
/// rays; each texel takes the nearest of those around it.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_find_proximity(alpi_proximity_job *job, const alpi_task_progress *progress);

#endif
