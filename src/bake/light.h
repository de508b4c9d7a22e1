// SPDX-License-Identifier: MIT
// What the files that bake irradiance share.
#ifndef ALPI_BAKE_LIGHT_H
#define ALPI_BAKE_LIGHT_H

#include "bake/job.h"
#include "maps/radiosity.h"
#include "transport/directional.h"
#include "transport/reference.h"

/// Where light is gathered, and what it becomes.
typedef struct alpi_light_task {
    const alpi_lighting *lighting;
    const alpi_tracer *tracer;
    const alpi_receivers *receivers; // texels of the job's atlas
    const uint32_t *order;           // [count] those with light of their own
    uint32_t count;
    const alpi_lattice *lattice;
    alpi_task_progress progress;
    alpi_reference_value *values;  // [receivers] out
    alpi_directional *directional; // [receivers] out, or NULL
} alpi_light_task;

/// Direct light and what surfaces make of it, by rays or hemicubes.
alp_result alpi_bake_radiosity(alpi_bake_job *job, const alpi_light_task *task);

/// Samples of each light at a texel in the first round.
uint32_t alpi_light_first_direct(const alpi_bake_job *job);

/// Gathers the last bounce at the texels, in rounds until the wanted error is stated or the time is
/// over, adds direct light, and fills task->values and the report.
/// @param fixed the gatherer of texels, or NULL: cosine rays, as many as it takes
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_rounds(alpi_bake_job *job, const alpi_light_task *task,
                             const alpi_gatherer *fixed, alpi_radiosity *solution);

#endif
