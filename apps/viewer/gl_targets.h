// SPDX-License-Identifier: MIT
// What is drawn into: the picture in light, and developed.
#ifndef VIEWER_GL_TARGETS_H
#define VIEWER_GL_TARGETS_H

#include <epoxy/gl.h>

#include <stdint.h>

typedef struct gl_targets {
    uint32_t width, height;
    GLuint light;     // RGBA32F: radiance, and whether something is seen
    GLuint triangles; // R32UI: the triangle of each pixel, 0xffffffff without one
    GLuint depth;     // 32-bit float: near plane / distance
    GLuint developed; // RGBA8: encoded as sRGB
    GLuint light_frame, developed_frame;
} gl_targets;

/// @return EXIT_DONE, or EXIT_FAILED after a message; gl_targets_destroy in both cases
int gl_targets_create(uint32_t width, uint32_t height, gl_targets *targets);
void gl_targets_destroy(gl_targets *targets);

#endif
