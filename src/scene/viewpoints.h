// SPDX-License-Identifier: MIT
// Where one may stand to look at a scene of which nothing is known but its bounding box.
#ifndef ALPI_SCENE_VIEWPOINTS_H
#define ALPI_SCENE_VIEWPOINTS_H

#include "scene/scene.h"

enum { ALPI_VIEWPOINT_LIMIT = 18 };

/// The camera for who may not ask rays: outside, above one corner of the box, from where the
/// picture holds all of it; inside, near an upper corner, where more area faces the centre than
/// faces away (a room), unless the scene is so flat that nobody can stand in it. Cost: a look at
/// each triangle.
alp_camera alpi_viewpoint_usual(const alp_scene *scene);

/// The usual one first, then from outside over the four corners of the box, level with its four
/// sides and from above; and from inside, where there is one, near its four upper corners and with
/// the back to its four sides. Of mirrored ones the one on the side of +z, then of +x, is first:
/// glTF's models face +z.
/// @return how many
uint32_t alpi_viewpoints(const alp_scene *scene, alp_camera cameras[ALPI_VIEWPOINT_LIMIT]);

#endif
