// SPDX-License-Identifier: MIT
// The settings of a bake beside those of a checkpoint: texts of lines "name value\n".
#ifndef ALPI_BASE_CHECKPOINT_COMPARE_H
#define ALPI_BASE_CHECKPOINT_COMPARE_H

#include "base/context.h"

/// Refuses a folder that keeps another bake.
/// @return ALP_OK (the same settings); INVALID_ARGUMENT (the message names the differences)
alp_result alpi_checkpoint_compare(alp_context *context, const char *folder, const char *ours,
                                   const char *theirs);

#endif
