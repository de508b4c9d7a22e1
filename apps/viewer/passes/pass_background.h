// SPDX-License-Identifier: MIT
// Finishes the light of a picture: sky and suns behind the surfaces, and alpha.
#ifndef VIEWER_PASS_BACKGROUND_H
#define VIEWER_PASS_BACKGROUND_H

#include "camera_view.h"
#include "passes/screen_pass.h"

#include <alpenglow/light.h>

typedef struct pass_background {
    screen_pass screen;
    GLuint sky;  // texture of SKY_IMAGE
    GLuint suns; // BUFFER_SUNS
    GLuint sun_count;
    GLint kind;           // SKY_...
    float up[3], down[3]; // radiance of SKY_COLORS
    float turn;           // of the image, in turns of the whole circle
} pass_background;

/// @param scene    whose suns are seen
/// @param lighting NULL = nothing is behind the surfaces
/// @return EXIT_DONE, or EXIT_FAILED after a message; pass_background_destroy in both cases
int pass_background_create(alp_context *context, const alp_scene *scene,
                           const alp_lighting_options *lighting, pass_background *pass);
void pass_background_destroy(pass_background *pass);
/// @param left the share of light from behind that the surfaces let through, one of lefts
void pass_background_draw(const pass_background *pass, const camera_view *view,
                          const gl_targets *targets, GLuint left);

#endif
