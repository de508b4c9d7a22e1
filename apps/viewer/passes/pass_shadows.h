// SPDX-License-Identifier: MIT
// Draws the depth of surfaces into the shadow maps of lights.
#ifndef VIEWER_PASS_SHADOWS_H
#define VIEWER_PASS_SHADOWS_H

#include "gl/gl_lights.h"
#include "gl/gl_scene.h"

typedef struct pass_shadows {
    GLuint program, frame;
} pass_shadows;

/// @return EXIT_DONE, or EXIT_FAILED after a message; pass_shadows_destroy in both cases
int pass_shadows_create(pass_shadows *pass);
void pass_shadows_destroy(pass_shadows *pass);
/// Draws the maps of all lights. Needed again only when something has moved.
/// @param object beside the scene, or NULL
void pass_shadows_draw(const pass_shadows *pass, const gl_scene *scene, const gl_scene *object,
                       const gl_lights *lights);

#endif
