// SPDX-License-Identifier: MIT
// The memory of a bake: its budget, and a forecast of its large arrays (bake_memory.c).
#ifndef ALPI_BAKE_BAKE_MEMORY_H
#define ALPI_BAKE_BAKE_MEMORY_H

#include "bake/job.h"

/// Keeps the allocations of the bake within options.sampling.memory_limit, or nine tenths of the
/// machine's memory, and within the budget that the context has.
void alpi_bake_begin_budget(alpi_bake_job *job);
/// Lowers the limit to the lowest of all ranks, whose machines may have less memory: loops are
/// chosen by it. @return as alpi_ranks_lowest
alp_result alpi_bake_share_budget(alpi_bake_job *job);
/// Restores the context's own budget. @return the result of the bake; LIMIT, with a message that
/// names the stage, in place of OUT_OF_MEMORY where the budget refused an allocation
alp_result alpi_bake_end_budget(alpi_bake_job *job, alp_result result);

/// Bytes that the large arrays of a bake on this atlas take at its peak, and the stage of that
/// peak. Small arrays and kept rays are left out: the bake needs somewhat more.
typedef struct alpi_memory_forecast {
    const char *stage;
    uint64_t bytes;
} alpi_memory_forecast;
alpi_memory_forecast alpi_bake_forecast_memory(const alpi_bake_job *job,
                                               const alp_atlas_info *atlas);
/// Refuses a bake whose forecast exceeds its limit, before any ray is traced.
/// @return ALP_OK; LIMIT
alp_result alpi_bake_check_memory(const alpi_bake_job *job, const alp_atlas_info *atlas);

#endif
