// SPDX-License-Identifier: MIT
// Pictures that light does not read.
#ifndef ALPI_FORMATS_NORMAL_MAPS_H
#define ALPI_FORMATS_NORMAL_MAPS_H

#include "scene/scene.h"

/// A picture of a scene, decoded now where it was not: one more owner of it, who destroys it. NULL
/// for one that cannot be read, with a warning, and where the scene's file is not known.
alp_result alpi_scene_open_image(const alp_scene *scene, uint32_t index, alp_image **image);

#endif
