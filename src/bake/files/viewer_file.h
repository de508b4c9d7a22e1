// SPDX-License-Identifier: MIT
// A viewer's own file in place of an asset.
#ifndef ALPI_BAKE_VIEWER_FILE_H
#define ALPI_BAKE_VIEWER_FILE_H

#include "bake/job.h"
#include "base/file_set.h"

/// Fails if the file, or a picture beside it, cannot be written.
alp_result alpi_bake_check_viewer_file(const alpi_bake_job *job, uint32_t pages);
/// Adds the file and the pictures that it names.
alp_result alpi_bake_add_viewer_file(const alpi_bake_job *job, alpi_file_set *files);

#endif
