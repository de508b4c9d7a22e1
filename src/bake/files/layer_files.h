// SPDX-License-Identifier: MIT
// The files of the layers of light in the maps folder.
#ifndef ALPI_BAKE_LAYER_FILES_H
#define ALPI_BAKE_LAYER_FILES_H

#include "bake/job.h"
#include "base/file_set.h"

/// Fails if a file of a layer cannot be written.
alp_result alpi_bake_check_layer_files(const alpi_bake_job *job, uint32_t pages);
/// Adds the files of all layers.
alp_result alpi_bake_add_layers(const alpi_bake_job *job, alpi_file_set *files);

#endif
