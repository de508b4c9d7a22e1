// SPDX-License-Identifier: MIT
// The processes of an MPI job as ranks of the library.
//
// Claims are counters in memory of rank 0, which others change by one-sided calls. Exchanges are
// collective calls that do not block: a waiting rank sleeps, and sees a request to stop. All calls
// run on the main thread (MPI_THREAD_FUNNELED).
#ifndef ALPI_RANKS_RANKS_MPI_H
#define ALPI_RANKS_RANKS_MPI_H

#include <alpenglow/ranks.h>

typedef struct alpi_ranks_mpi alpi_ranks_mpi;

/// Makes the ranks of MPI_COMM_WORLD. All processes call it, after MPI_Init_thread.
/// @param stops whether this process was told to stop: a wait for other ranks then ends soon
/// @return NULL: MPI or memory failed
alpi_ranks_mpi *alpi_ranks_mpi_create(bool (*stops)(void));
/// Frees the ranks. All processes call it, unless the job is broken.
void alpi_ranks_mpi_destroy(alpi_ranks_mpi *ranks);

/// The calls for a context. They live as long as `ranks`.
const alp_ranks *alpi_ranks_mpi_calls(const alpi_ranks_mpi *ranks);

/// Collects one number of each rank, outside of the library's work.
/// @param values [count of ranks] out
/// @return false: the job is broken
bool alpi_ranks_mpi_meet(alpi_ranks_mpi *ranks, int value, int *values);

/// Whether a rank is gone, or ranks made different calls. No call can follow but MPI_Abort.
bool alpi_ranks_mpi_is_broken(const alpi_ranks_mpi *ranks);

#endif
