// SPDX-License-Identifier: MIT
// The camera of the command line: --camera.
#ifndef COMMAND_CAMERAS_H
#define COMMAND_CAMERAS_H

#include "session.h"

/// Reads --camera.
/// @param origin  of the scene in the world of its file
/// @param options out: camera or camera_index
/// @return EXIT_DONE, or EXIT_USAGE after a message
int camera_read(const command_line *arguments, const double origin[3], alp_render_options *options);

/// Reads it again for the scene that was loaded. A camera given by number must exist.
/// @return EXIT_DONE, or an exit code after a message
int camera_find(const session *s, const command_line *arguments, alp_render_options *options);

#endif
