// SPDX-License-Identifier: MIT
// Texts of a picture: how it was made.
#ifndef VIEWER_PICTURE_TEXTS_H
#define VIEWER_PICTURE_TEXTS_H

#include "options/options.h"

#include <alpenglow/image.h>
#include <alpenglow/scene.h>

/// Sources of the texts of a picture.
typedef struct picture_facts {
    const command_line *arguments;
    const alp_scene *scene;
    const alp_camera *camera;
    const char *renderer; // of OpenGL
    double exposure;      // EV
} picture_facts;

/// Adds the texts Software, Command, Camera (as for --camera), Exposure (as for --exposure) and
/// OpenGL.
alp_result picture_add_texts(alp_image *picture, const picture_facts *facts);

#endif
