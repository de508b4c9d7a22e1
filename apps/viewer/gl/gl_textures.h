// SPDX-License-Identifier: MIT
// Textures and samplers of images.
#ifndef VIEWER_GL_TEXTURES_H
#define VIEWER_GL_TEXTURES_H

#include <alpenglow/image.h>

#include <epoxy/gl.h>

#include <stdbool.h>

/// Refuses images that are larger than the card's textures. @param what the image, for the message
/// @return EXIT_DONE, or EXIT_FAILED after a message
int gl_texture_check(const char *what, uint32_t width, uint32_t height);
/// Makes a texture of RGBA with mip levels. Grey becomes RGB, and missing alpha 1.
/// @param srgb red, green and blue are decoded from sRGB, each texel before the filter
/// @return EXIT_DONE, or EXIT_FAILED after a message
int gl_texture_create(const alp_image *image, bool srgb, GLuint *texture);
/// A texture of one white texel.
GLuint gl_texture_white(void);

/// Makes nine samplers, 3 × wrap_u + wrap_v, without anisotropy.
/// @param level_zero true: bilinear, without mip levels; false: trilinear
void gl_samplers_create(bool level_zero, GLuint samplers[9]);

#endif
