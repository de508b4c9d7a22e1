// SPDX-License-Identifier: MIT
// State of alpi_final_gather, its rays, and how it measures its errors.
#ifndef ALPI_MAPS_FINAL_GATHER_JOB_H
#define ALPI_MAPS_FINAL_GATHER_JOB_H

#include "base/tasks.h"
#include "maps/radiosity/final_gather.h"

enum { ALPI_FINAL_GATHER_LIST = 1 << 16 }; // texels traced at a time, enough for all workers

typedef struct alpi_final_gather_job {
    const alpi_final_gather_options *options;
    alpi_lattice lattice; // states and values are of this map
    alpi_task_progress progress;
    alpi_final_gather_report *report;
    uint8_t *marked; // [texels] to be traced next
    uint32_t *list;  // [ALPI_FINAL_GATHER_LIST], or count if that is less
    float noise;     // standard deviation of the mean of the channels, over the RMS light
    float mean;      // of the light
    float factor;    // true variance over that of the replicates
    uint32_t level;
    bool flood;
    uint64_t sent, expected; // texels that traced rays, held-out ones included
} alpi_final_gather_job;

// --- rays (final_gather_rays.c) ------------------------------------------------------------------

/// Multiplies a variance by job->factor.
void alpi_final_gather_scale(const alpi_final_gather_job *job, alpi_reference_value *value);
/// Traces all marked texels and clears the marks. @return ALP_OK; CANCELLED
alp_result alpi_final_gather_trace_marked(alpi_final_gather_job *job);
/// Fills job->list with up to `most` texels of a state, evenly and at random.
/// @param count of the texels of that state   @return the number chosen
uint32_t alpi_final_gather_choose(const alpi_final_gather_job *job, alpi_texel_state state,
                                  uint32_t count, uint32_t most, uint32_t stream);
/// Traces `count` texels of job->list without changing the map. @param found [count] out
/// @return ALP_OK; CANCELLED
alp_result alpi_final_gather_measure(alpi_final_gather_job *job, uint32_t count,
                                     const alpi_gatherer *gatherer, alpi_reference_value *found);

// --- interpolated light (stencil_light.c) --------------------------------------------------------

/// Interpolates the means of a texel, at least 0, and the sky's part of them.
void alpi_stencil_light(const alpi_gather_job *gather, uint32_t texel, const alpi_stencil *stencil);
/// Interpolates gather->directional, unless NULL.
void alpi_stencil_directional(const alpi_gather_job *gather, uint32_t texel,
                              const alpi_stencil *stencil);

// --- errors --------------------------------------------------------------------------------------

/// Measures job->factor by check texels and applies it to all traced texels (variance_factor.c).
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_final_gather_find_factor(alpi_final_gather_job *job, uint32_t traced);
/// Mean square error of the interpolated texels by channel (held_out.c).
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_final_gather_measure_interpolated(alpi_final_gather_job *job, uint32_t interpolated,
                                                  float variance[3]);

#endif
