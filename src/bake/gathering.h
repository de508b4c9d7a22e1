// SPDX-License-Identifier: MIT
// The stages that gather at texels: their common state, and their loop over the objects.
#ifndef ALPI_BAKE_GATHERING_H
#define ALPI_BAKE_GATHERING_H

#include "bake/job.h"

/// Makes the common state: lattice, objects, and arrays for the texels of the atlas.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_gathering_open(alpi_bake_job *job);
/// Releases all that rays need. The lattice and the gathered values stay.
void alpi_gathering_end_rays(alpi_bake_job *job);
/// Releases everything, with the values that no page has taken. Twice does nothing.
void alpi_gathering_close(alpi_bake_job *job);

/// Builds the tracer of an object and the setup of its rays, and releases those of the object
/// before. A bake of one object builds them once for all stages.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED; UNSUPPORTED
alp_result alpi_gathering_open_object(alpi_bake_job *job, const alpi_object *object,
                                      const alpi_task_progress *progress);

/// Time at which occlusion must end, in alpi_seconds(); HUGE_VAL: none. Light gets the other half.
double alpi_gathering_deadline(const alpi_bake_job *job);

/// A stage that takes the objects one by one.
typedef struct alpi_object_stage {
    const char *name; // for progress
    uint64_t rays;    // of all objects, about
    alp_result (*each)(alpi_bake_job *job, alpi_object *object, const alpi_task_progress *progress);
    /// Runs after the last of several objects; NULL: nothing to do.
    alp_result (*join)(alpi_bake_job *job, const alpi_task_progress *progress);
} alpi_object_stage;
/// Runs a stage. The user sees the progress of all objects as one.
alp_result alpi_gathering_run(alpi_bake_job *job, const alpi_object_stage *stage);

#endif
