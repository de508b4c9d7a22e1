// SPDX-License-Identifier: MIT
// The camera of a scene that has none.
#ifndef ALPI_RENDER_AUTOMATIC_CAMERA_H
#define ALPI_RENDER_AUTOMATIC_CAMERA_H

#include "scene/scene.h"

/// Camera `index` of the scene; past the last, the one of a dozen and a half eyes about and inside
/// its box that sees most: the front of most of its area, and of most of its surfaces. The usual
/// view (alp_scene_get_camera) stays where no other sees much more. It depends on the scene alone,
/// not on the picture's shape.
/// Cost: the scene's tracer, if it is not there yet, a look at each triangle and 9,216 rays.
/// @return ALP_OK; OUT_OF_MEMORY; UNSUPPORTED (the ray tracer fails); CANCELLED
alp_result alpi_camera_choose(const alp_scene *scene, uint32_t index, alp_progress_fn *progress,
                              void *progress_user, alp_camera *camera);

/// Moves a camera outside the scene's box, along its view and across it, until a picture of this
/// shape just holds all usable triangles, with a margin of 2.5 % at each side. It looks the same
/// way as before. One inside the box stays. Cost: a look at each triangle.
/// @param aspect width over height
void alpi_camera_frame(const alp_scene *scene, float aspect, alp_camera *camera);

#endif
