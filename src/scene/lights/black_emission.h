// SPDX-License-Identifier: MIT
// Which triangles of emissive materials show only black of their texture.
#ifndef ALPI_SCENE_BLACK_EMISSION_H
#define ALPI_SCENE_BLACK_EMISSION_H

#include "scene/scene.h"

/// Marks triangles whose emission texture is black wherever they can read it. Never one that can
/// show light; a triangle may be left unmarked where others lie around it in the picture.
/// @param dark [triangle_count] in and out
/// @return ALP_OK; OUT_OF_MEMORY
/// Cost: a look at each texel of each emission texture; four bytes for each of one at a time.
alp_result alpi_lighting_mark_dark(const alp_scene *scene, bool *dark);

#endif
