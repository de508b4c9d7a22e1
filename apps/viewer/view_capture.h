// SPDX-License-Identifier: MIT
// --capture: spherical harmonics of the light at a point.
#ifndef VIEWER_VIEW_CAPTURE_H
#define VIEWER_VIEW_CAPTURE_H

#include "view_job.h"

/// Texels along an edge of the cube map, and so the size of the targets.
enum { CAPTURE_SIDE = 256 };

/// Reads the point of --capture.
/// @param origin of the scene in the world of its file   @param point out, metres
/// @return EXIT_DONE, or EXIT_USAGE after a message
int capture_read(const command_line *arguments, const double origin[3], float point[3]);
/// Draws the light, and prints its coefficients. @return the exit code
int view_capture(view_job *job);

#endif
