// SPDX-License-Identifier: MIT
// The checkpoint of a bake: opened before its first loop, closed after its outputs are written.
#ifndef ALPI_BAKE_CHECKPOINT_H
#define ALPI_BAKE_CHECKPOINT_H

#include "bake/job.h"

/// Refuses options that a checkpoint or a shard cannot keep.
alp_result alpi_bake_check_checkpoint(const alpi_bake_job *job);
/// Begins the bake with all ranks, if there are several. alpi_ranks_end must follow.
/// @return ALP_OK; INVALID_ARGUMENT (options that ranks do not have); IO (a rank is gone, or has
///         another scene or other options); OUT_OF_MEMORY
alp_result alpi_bake_begin_ranks(alpi_bake_job *job);
/// Opens the checkpoint of the options, if they have one.
alp_result alpi_bake_open_checkpoint(alpi_bake_job *job);
/// After the last gather. @param ends out: this process writes no outputs
/// @return ALP_OK; INVALID_DATA (a merge lacks tiles: the message lists the shards)
alp_result alpi_bake_end_shard(alpi_bake_job *job, bool *ends);
/// @param complete outputs are written, or all tiles of a shard
void alpi_bake_close_checkpoint(alpi_bake_job *job, bool complete);

/// The relative error that a stage states so far, for the state of the checkpoint.
void alpi_bake_note_error(alp_context *context, double error);

#endif
