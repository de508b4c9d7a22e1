// SPDX-License-Identifier: MIT
// Draws the sky behind the surfaces.
#ifndef VIEWER_PASS_BACKGROUND_H
#define VIEWER_PASS_BACKGROUND_H

#include "camera_view.h"
#include "gl_targets.h"

#include <alpenglow/light.h>

#include <stdbool.h>

typedef struct pass_background {
    GLuint program;
    GLint kind; // SKY_…
    float up[3], down[3];
} pass_background;

/// @return EXIT_DONE, or EXIT_FAILED after a message; pass_background_destroy in both cases
int pass_background_create(const alp_lighting_options *lighting, pass_background *pass);
void pass_background_destroy(pass_background *pass);
/// Draws where no surface is. The targets and the depth test are those of pass_surfaces.
void pass_background_draw(const pass_background *pass, const camera_view *view);

#endif
