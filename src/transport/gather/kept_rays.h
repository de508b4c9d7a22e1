// SPDX-License-Identifier: MIT
// Rays that are traced once and remembered: what each met is the number of a cell of surface light,
// so that every later pass of light is a table look-up.
#ifndef ALPI_TRANSPORT_KEPT_RAYS_H
#define ALPI_TRANSPORT_KEPT_RAYS_H

#include "transport/gather/gather.h"

typedef struct alpi_kept_rays {
    alp_context *context;
    uint32_t receivers; // that there is room for
    uint32_t rays;      // of each
    uint32_t *cells;    // [receivers][rays]
    uint8_t *traced;    // [receivers] 1 for rows whose rays were traced by this process
    bool by_list;       // the i-th row is of the i-th receiver of the one list that all jobs have,
                        // not of receiver i; the caller's to set, before any is traced
} alpi_kept_rays;

/// Bytes of the rays of a receiver.
uint64_t alpi_kept_rays_size(const alpi_gatherer *gatherer);
/// Whether kept rays of so many bytes fit now: at most `most`. Within a budget a quarter of the
/// bytes held is left free beside them, for what is allocated while they are kept. Ranks that work
/// together get the answer of the one with least room, since each holds other bytes: all of them
/// make this call. The answer is noted as a choice between loops, so that a process resumed with
/// another one is right.
/// @param fit out  @return as alpi_ranks_lowest
alp_result alpi_kept_rays_fit(alp_context *context, uint64_t bytes, uint64_t most, bool *fit);

/// Makes room for receivers [0, count); what is there stays. Zeroed is where to begin.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_kept_rays_reserve(alp_context *context, const alpi_gatherer *gatherer,
                                  uint32_t count, alpi_kept_rays *kept);
void alpi_kept_rays_destroy(alpi_kept_rays *kept);

/// Traces the rays of the listed receivers, and writes to job->skies what those of them bring that
/// meet nothing, and job->lost. Needs alpi_gather_meets_cells.
/// @return ALP_OK; CANCELLED
alp_result alpi_kept_rays_trace(const alpi_gather_job *job, const alpi_task_progress *progress,
                                alpi_kept_rays *kept);

/// What alpi_gather_irradiance would find for the listed receivers without a sky, bit for bit, with
/// the light that is in the cells now. Rays that another process traced are traced first. Leaves
/// job->skies alone.
/// @return ALP_OK; CANCELLED
alp_result alpi_kept_rays_gather(const alpi_gather_job *job, const alpi_kept_rays *kept,
                                 const alpi_task_progress *progress);

#endif
