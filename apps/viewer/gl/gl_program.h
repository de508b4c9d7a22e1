// SPDX-License-Identifier: MIT
// Programs of shaders. The build makes a gl_shader of each file in shaders/.
#ifndef VIEWER_GL_PROGRAM_H
#define VIEWER_GL_PROGRAM_H

#include <epoxy/gl.h>

#include <stddef.h>

/// A shader with its includes resolved.
typedef struct gl_shader {
    const char *text;
    const char *const *files; // [file_count] names by the numbers that #line gives; first its own
    size_t file_count;
} gl_shader;

/// Compiles and links. @return 0 after a message that names file and line
GLuint gl_program_create(const gl_shader *vertex, const gl_shader *fragment);
/// The same of a compute shader.
GLuint gl_program_create_compute(const gl_shader *shader);

#endif
