// SPDX-License-Identifier: MIT
// Draws a layer of surfaces: the nearest, or the nearest behind the layer before.
#ifndef VIEWER_PASS_SURFACES_H
#define VIEWER_PASS_SURFACES_H

#include "camera_view.h"
#include "gl_scene.h"
#include "gl_targets.h"
#include "view_modes.h"

typedef struct pass_surfaces {
    GLuint program, query;
    const view_mode *mode;
    bool metals_black;
} pass_surfaces;

/// @return EXIT_DONE, or EXIT_FAILED after a message; pass_surfaces_destroy in both cases
int pass_surfaces_create(const view_mode *mode, bool metals_black, pass_surfaces *pass);
void pass_surfaces_destroy(pass_surfaces *pass);
/// Draws into layer_frames[layer % 2].
/// @param layer its number, from 0
/// @return whether it shows anything
bool pass_surfaces_draw(const pass_surfaces *pass, const gl_scene *scene, const mode_light *light,
                        const camera_view *view, const gl_targets *targets, uint32_t layer);

#endif
