// SPDX-License-Identifier: MIT
// The run of view: a picture, or the pictures of a flight.
#ifndef VIEWER_VIEW_RUN_H
#define VIEWER_VIEW_RUN_H

#include "options/options.h"

/// @return the exit code
int view_run(const command_line *arguments);

#endif
