// SPDX-License-Identifier: MIT
// State of alpi_final_gather, its rays, and how it measures its errors.
#ifndef ALPI_MAPS_FINAL_GATHER_JOB_H
#define ALPI_MAPS_FINAL_GATHER_JOB_H

#include "base/tasks.h"
#include "maps/radiosity/final_gather.h"

enum { ALPI_FINAL_GATHER_LIST = 1 << 16 }; // texels traced at a time, enough for all workers

typedef struct alpi_texel_list {
    const uint32_t *texels;
    uint32_t count;
} alpi_texel_list;

typedef struct alpi_final_gather_job {
    const alpi_final_gather_options *options;
    alpi_lattice lattice; // states and values are of this map
    alpi_task_progress progress;
    alpi_final_gather_report *report;
    uint8_t *wanted;   // [texels] to be traced next
    uint32_t *by_pass; // [count] the order, pass by pass; NULL if not adaptive
    uint32_t pass_first[ALPI_LATTICE_PASSES + 1];
    alpi_texel_list now; // texels of the current loop
    uint32_t *list;      // [ALPI_FINAL_GATHER_LIST], or count if that is less
    float noise;         // standard deviation of the mean of the channels, over the RMS light
    float level;         // mean light
    float factor;        // true variance over that of the replicates
    uint32_t pass;
    bool flood;
    uint64_t gathered, expected; // texels, held-out ones included
} alpi_final_gather_job;

uint32_t alpi_final_gather_count_traced(const alpi_final_gather_job *job);

// --- rays (final_gather_rays.c) ------------------------------------------------------------------

/// Multiplies a variance by job->factor.
void alpi_final_gather_scale(const alpi_final_gather_job *job, alpi_reference_value *value);
/// Traces all wanted texels of a list. @return ALP_OK; CANCELLED
alp_result alpi_final_gather_trace_wanted(alpi_final_gather_job *job, alpi_texel_list texels);
/// Fills job->list with up to `most` texels of a state, evenly and at random.
/// @param count of the texels of that state   @return the number chosen
uint32_t alpi_final_gather_choose(const alpi_final_gather_job *job, alpi_texel_state state,
                                  uint32_t count, uint32_t most, uint32_t stream);
/// Traces `count` texels of job->list without changing the map. @param found [count] out
/// @return ALP_OK; CANCELLED
alp_result alpi_final_gather_measure(alpi_final_gather_job *job, uint32_t count,
                                     const alpi_gatherer *gatherer, alpi_reference_value *found);

// --- errors --------------------------------------------------------------------------------------

/// Measures job->factor by check texels and applies it to all traced texels (variance_factor.c).
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_final_gather_find_factor(alpi_final_gather_job *job, uint32_t traced);
/// Mean square error of the interpolated texels by channel (held_out.c).
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_final_gather_measure_interpolated(alpi_final_gather_job *job, uint32_t interpolated,
                                                  float variance[3]);

#endif
