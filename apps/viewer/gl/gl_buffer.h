// SPDX-License-Identifier: MIT
// Storage buffers.
#ifndef VIEWER_GL_BUFFER_H
#define VIEWER_GL_BUFFER_H

#include <epoxy/gl.h>

#include <stddef.h>

/// Makes a buffer that shaders only read. Shaders always have an element to read.
/// @param what   whose buffer it is, for the message
/// @param data   [size] bytes; NULL: glNamedBufferSubData fills it
/// @param buffer out: 0 after a message
/// @return EXIT_DONE, or EXIT_FAILED after a message
int gl_buffer_load(const char *what, const void *data, size_t size, GLuint *buffer);

#endif
