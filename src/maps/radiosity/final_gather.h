// SPDX-License-Identifier: MIT
// The final gather: bounced light at the texels of an atlas, over the adaptive lattice.
//
// Bounced light varies slowly, except where surfaces meet, so most texels are interpolated. Levels,
// stencils and the flood are those of lattice.h; stencils also run along borders of charts. The
// limits of the judge scale with the noise of the rays and with the light. The judge compares the
// means of the channels; the same stencils interpolate each channel and the sky's part.
// Based on: H. Elias. Radiosity (the adaptive light map).
#ifndef ALPI_MAPS_FINAL_GATHER_H
#define ALPI_MAPS_FINAL_GATHER_H

#include "maps/texels/lattice.h"
#include "transport/gather/gather.h"

enum { ALPI_HELD_OUT = 1024 };

/// Held-out texels: interpolated, and also traced by independent rays. Their differences measure
/// the error of interpolation, which no repetition of the same rays would reveal. The first of
/// several maps of the same light chooses them, evenly and at random among those that it
/// interpolates. Every map traces them.
typedef struct alpi_held_out {
    uint32_t count; // 0: none yet
    uint32_t texels[ALPI_HELD_OUT];
    alpi_reference_value values[ALPI_HELD_OUT]; // by the independent rays of the last map
} alpi_held_out;

/// Mean square error of texels by channel, compared with independent values y of known variance:
/// E[(x − y)²] − Var y = E[(x − truth)²], at least 0.
void alpi_held_out_error(const uint32_t *texels, const alpi_reference_value *found, uint32_t count,
                         const alpi_reference_value *values, float variance[3]);

typedef struct alpi_final_gather_options {
    const alpi_gather_job *gather; // list and count are ignored; its gatherer measures its error
    const uint32_t *order;         // [count] texels, neighbours together
    uint32_t count;
    const uint8_t *proximity; // [texels] alpi_proximity, or NULL
    bool adaptive;            // false: all texels are traced
    alpi_held_out *held_out;  // NULL: errors of this map alone; else in and out
    // A gatherer like that of `gather` with other random numbers. It traces held-out texels, some
    // of which this map may trace itself, and check texels if replicates are joined.
    const alpi_gatherer *independent;
    bool joined;  // replicates share one sequence (cosine_rays.h), so their spread is too large
    float *means; // [texels] scratch, or NULL
} alpi_final_gather_options;

typedef struct alpi_final_gather_report {
    uint64_t traced, interpolated; // texels
    uint64_t rays;
    float factor; // joined: true variance over that of the replicates
} alpi_final_gather_report;

/// Writes the values (with variances), skies and directional light of the gather job for the texels
/// of the order.
///
/// The variance of a traced texel is pooled with its neighbours. If replicates are joined, check
/// texels (variance_factor.c) correct it. The variance of interpolated texels is their mean square
/// difference to independent rays from held-out texels, less the variance of those rays. So it
/// contains the error of interpolation. It is 0 if an earlier map chose the held-out texels: the
/// caller then compares the mean of all maps with them.
/// @param states [texels] out: alpi_texel_state of those in the order
/// @param report in: `traced` of a similar map, for progress, or 0; `factor` of a similar map, used
///               if too few texels are traced to measure it, or 0; out: all fields
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_final_gather(const alpi_final_gather_options *options, const alpi_lattice *lattice,
                             const alpi_task_progress *progress, uint8_t *states,
                             alpi_final_gather_report *report);

/// The lattice of a final gather, also for later interpolation: straight.
/// @param states, values [texels] of it
alpi_lattice alpi_final_gather_lattice(const alpi_lattice *lattice, uint8_t *states, float *values);

#endif
