// SPDX-License-Identifier: MIT
// Draws the surfaces: light, and the number of the triangle in each pixel.
#ifndef VIEWER_PASS_SURFACES_H
#define VIEWER_PASS_SURFACES_H

#include "camera_view.h"
#include "gl_scene.h"
#include "gl_targets.h"
#include "view_modes.h"

typedef struct pass_surfaces {
    GLuint program;
    const view_mode *mode;
    bool metals_black;
} pass_surfaces;

/// @return EXIT_DONE, or EXIT_FAILED after a message; pass_surfaces_destroy in both cases
int pass_surfaces_create(const view_mode *mode, bool metals_black, pass_surfaces *pass);
void pass_surfaces_destroy(pass_surfaces *pass);
/// Clears the targets and draws into them.
void pass_surfaces_draw(const pass_surfaces *pass, const gl_scene *scene, const mode_light *light,
                        const camera_view *view, const gl_targets *targets);

#endif
