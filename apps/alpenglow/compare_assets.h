// SPDX-License-Identifier: MIT
// alpenglow compare of two baked assets, and functions shared with that of images.
#ifndef COMMAND_COMPARE_ASSETS_H
#define COMMAND_COMPARE_ASSETS_H

#include "options/options.h"

#include <alpenglow/alpenglow.h>

/// Whether an operand names a scene.
bool compare_is_scene(const char *operand);

/// Compares the maps of the two operands, which are scenes, and prints the figures.
/// @return the exit code
int compare_assets(alp_context *context, const command_line *arguments);

/// Whether rmse is within --max-rmse. @param none the message if nothing was compared
/// @return EXIT_DONE, or EXIT_FAILED after a message
int compare_judge(const command_line *arguments, uint64_t compared, double rmse, const char *none);

#endif
