// SPDX-License-Identifier: MIT
// The files of the scene that was read: a bake overwrites none of them, even by force.
#ifndef ALPI_BAKE_OWN_FILES_H
#define ALPI_BAKE_OWN_FILES_H

#include "bake/job.h"
#include "base/guard.h"

/// Guards the files that the asset of the scene names, until alpi_bake_unguard. If the output is
/// the asset itself and an earlier bake wrote it, its maps and its .mtl stay out of the guard.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_bake_guard(const alpi_bake_job *job, alpi_guard *guard);
void alpi_bake_unguard(const alpi_bake_job *job, alpi_guard *guard);

#endif
