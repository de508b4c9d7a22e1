// SPDX-License-Identifier: MIT
// The memory that a bake will need (memory.c).
#ifndef ALPI_BAKE_BAKE_MEMORY_H
#define ALPI_BAKE_BAKE_MEMORY_H

#include "bake/job.h"

/// Peak memory of a bake with these options on this atlas, without the scene and the tracer.
uint64_t alpi_bake_memory(const alp_atlas_info *atlas, const alp_scene *scene,
                          const alp_bake_options *options);
/// Refuses a bake whose peak is above the limit or nine tenths of the machine's memory, even if no
/// rays are kept. Sets job->kept_limit.
/// @param more_pieces of texels, beyond one of each
/// @return ALP_OK; LIMIT
alp_result alpi_bake_check_memory(alpi_bake_job *job, const alp_atlas_info *atlas,
                                  uint64_t more_pieces);

#endif
