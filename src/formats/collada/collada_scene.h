// SPDX-License-Identifier: MIT
// COLLADA → scene.
#ifndef ALPI_FORMATS_COLLADA_SCENE_H
#define ALPI_FORMATS_COLLADA_SCENE_H

#include "scene/scene.h"

/// Reads a .dae or .zae into a scene and keeps the document with it (ALPI_ATTACHMENT_COLLADA).
alp_result alpi_collada_read_scene(alp_context *context, const char *path, alp_scene **scene);
/// Decodes an image of a scene that was read from COLLADA; NULL in *image, with a warning, where it
/// cannot be read.
alp_result alpi_collada_read_image(const alp_scene *scene, uint32_t index, alp_image **image);
/// Warns, once a kind, of what the document has and a file in another format will not have. Nothing
/// where the scene is not from COLLADA.
void alpi_collada_tell_losses(const alp_scene *scene);

#endif
