// SPDX-License-Identifier: MIT
// Framebuffers: layers of surfaces, the picture in light, and the developed one.
#ifndef VIEWER_GL_TARGETS_H
#define VIEWER_GL_TARGETS_H

#include <epoxy/gl.h>

#include <stdint.h>

typedef struct gl_targets {
    uint32_t width, height;
    GLuint triangles; // R32UI: the nearest triangle of each pixel, 0xffffffff without one
    // Opaque surfaces.
    GLuint opaque_light, opaque_through, opaque_depth; // as of a layer
    GLuint opaque_frame;
    // One layer of panes: the nearest that lie behind the layer before, whose depth is the other
    // one of two.
    GLuint layer_light; // RGBA32F: radiance
    GLuint
        layer_through; // RGBA32F: share of light from behind that goes through; 1 without a surface
    GLuint depths[2];  // 32-bit float: near plane / distance
    GLuint layer_frames[2];
    // The layers so far.
    GLuint sum;      // RGBA32F: radiance
    GLuint lefts[2]; // RGBA32F: share of light from behind; before and after a layer
    GLuint sum_frames[2];
    // The picture.
    GLuint light;     // RGBA32F: radiance over what is covered, and alpha
    GLuint developed; // RGBA8: encoded as sRGB
    GLuint light_frame, developed_frame;
} gl_targets;

/// @return EXIT_DONE, or EXIT_FAILED after a message; gl_targets_destroy in both cases
int gl_targets_create(uint32_t width, uint32_t height, gl_targets *targets);
void gl_targets_destroy(gl_targets *targets);

/// Sets a frame and the whole of it to be drawn into.
void gl_targets_bind(const gl_targets *targets, GLuint frame);

#endif
