// SPDX-License-Identifier: MIT
// The object of the command line: --object.
#ifndef COMMAND_OBJECTS_H
#define COMMAND_OBJECTS_H

#include "options/options.h"

#include <alpenglow/render.h>

/// Reads --object. Without it, `object` stays.
/// @param origin of the scene in the world of its file
/// @return EXIT_DONE, or EXIT_USAGE after a message
int object_read(const command_line *arguments, const double origin[3], alp_render_object *object);

#endif
