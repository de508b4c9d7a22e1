// SPDX-License-Identifier: MIT
// The stage that writes: maps of the maps folder, and the asset.
#ifndef ALPI_BAKE_OUTPUTS_H
#define ALPI_BAKE_OUTPUTS_H

#include "bake/job.h"

/// Fails before the long work if a file could not be written at its end. A bake calls it for one
/// page before the atlas is made, and for all pages after. Makes the maps folder.
/// @return ALP_OK; IO; OUT_OF_MEMORY; UNSUPPORTED: the scene was not read from the kind of file
///         that is to be written
alp_result alpi_bake_check_outputs(const alpi_bake_job *job, uint32_t pages);
/// The same for the asset alone. Makes no folder, so that an estimate may call it.
alp_result alpi_bake_check_output(const alpi_bake_job *job, uint32_t pages);

/// The stage: writes maps and asset. No file appears at its place before all are encoded.
/// @return ALP_OK; IO; OUT_OF_MEMORY; CANCELLED
alp_result alpi_bake_write(alpi_bake_job *job);

#endif
