// SPDX-License-Identifier: MIT
// State of alpi_radiosity_solve, and its steps in order.
#ifndef ALPI_MAPS_SOLVER_H
#define ALPI_MAPS_SOLVER_H

#include "maps/radiosity/acceleration.h"
#include "maps/radiosity/radiosity.h"
#include "transport/gather/kept_rays.h"

typedef struct alpi_solver {
    alpi_radiosity *r;
    alpi_gather_scene from;
    alpi_receivers patches;
    alpi_kept_rays kept;
    double first_light; // Σ area · (E₀ + sky) over receivers and channels, the same in each pass
    double change, former; // mean change over mean light of the last pass and of the one before
    bool accelerated;
    alpi_acceleration acceleration;
    alpi_task_progress progress;
} alpi_solver;

static inline size_t alpi_patches_sides(const alpi_patches *patches)
{
    return patches->two_sided ? 2 : 1;
}

/// The patch of a receiver. @param back out: 1 for a back, else 0
static inline uint32_t alpi_receiver_patch(const alpi_patches *patches, uint32_t receiver,
                                           size_t *back)
{
    *back = receiver >= patches->patch_count ? 1 : 0;
    return *back != 0 ? receiver - patches->patch_count : receiver;
}

/// Direct light E₀ of listed texels.
/// @param directional [texels] out, or NULL
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_solver_direct(const alpi_solver *solver, const uint32_t *list, uint32_t count,
                              alpi_directional *directional);

/// Finds all receivers: fronts, and the backs that rays of other receivers meet. Traces their first
/// rays, which measure a soft sky, lost light and seen backs, and are kept if memory allows.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_solver_trace_receivers(alpi_solver *solver);
/// The job by which listed receivers gather.
alpi_gather_job alpi_solver_job(const alpi_solver *solver, const uint32_t *list, uint32_t count);

/// Gathers at all receivers the light that is in the cells. @param values [sides × patches] out
/// @return ALP_OK; CANCELLED
alp_result alpi_solver_gather(const alpi_solver *solver, alpi_reference_value *values);
/// Copies the means of all receivers.
void alpi_solver_copy_means(const alpi_solver *solver, const alpi_reference_value *values,
                            float (*means)[3]);
/// Runs bounce passes until later ones would add less than the tolerance, or the limit is reached.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_solver_bounce(alpi_solver *solver);

/// Repeats the bounce passes for each layer alone, except the last, which texels gather themselves.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_solver_bounce_layers(const alpi_solver *solver);

#endif
