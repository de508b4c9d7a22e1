// SPDX-License-Identifier: MIT
// Pictures out of the targets.
#ifndef VIEWER_PICTURE_H
#define VIEWER_PICTURE_H

#include "gl/gl_targets.h"

#include <alpenglow/image.h>

/// Reads the light of a picture as float RGBA. @param image out, which the caller destroys
alp_result picture_read_light(alp_context *context, const gl_targets *targets, alp_image **image);
/// Reads the developed picture as 8-bit RGB. @param image out, which the caller destroys
alp_result picture_read_developed(alp_context *context, const gl_targets *targets,
                                  alp_image **image);
/// Reads the triangles of the pixels. @param triangles out: [height][width], UINT32_MAX: none
void picture_read_triangles(const gl_targets *targets, uint32_t *triangles);

#endif
