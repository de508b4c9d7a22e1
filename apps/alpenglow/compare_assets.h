// SPDX-License-Identifier: MIT
// alpenglow compare of two baked assets, and what it has in common with that of images.
#ifndef COMMAND_COMPARE_ASSETS_H
#define COMMAND_COMPARE_ASSETS_H

#include "options.h"

#include <alpenglow/alpenglow.h>

/// Whether an operand names a scene.
bool compare_is_scene(const char *operand);

/// Compares the maps of the two operands, which are scenes, and prints what is asked for.
/// @return the exit code
int compare_assets(alp_context *context, const command_line *arguments);

/// Whether --max-rmse is kept. @param none said where nothing was compared
/// @return EXIT_DONE, or EXIT_FAILED after a message
int compare_judge(const command_line *arguments, uint64_t compared, double rmse, const char *none);

#endif
