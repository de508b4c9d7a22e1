// SPDX-License-Identifier: MIT
// A pass over every pixel of a picture: one triangle that covers it, and a fragment shader.
#ifndef VIEWER_SCREEN_PASS_H
#define VIEWER_SCREEN_PASS_H

#include "gl/gl_program.h"
#include "gl/gl_targets.h"

typedef struct screen_pass {
    GLuint program, array;
} screen_pass;

/// @return EXIT_DONE, or EXIT_FAILED after a message; screen_pass_destroy in both cases
int screen_pass_create(const gl_shader *fragment, screen_pass *pass);
void screen_pass_destroy(screen_pass *pass);
/// Binds the program and a framebuffer of the targets. Depth is not tested.
void screen_pass_bind(const screen_pass *pass, const gl_targets *targets, GLuint frame);
/// Draws the pass that is bound.
void screen_pass_draw(void);

#endif
