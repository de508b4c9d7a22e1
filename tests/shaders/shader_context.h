// SPDX-License-Identifier: MIT
// OpenGL without a screen, and fragment shaders that compute a row of numbers.
#ifndef SHADER_CONTEXT_H
#define SHADER_CONTEXT_H

#include <stdbool.h>
#include <stdint.h>

#include <GLES3/gl3.h>

typedef enum shader_language { SHADER_ES_300, SHADER_330, SHADER_LANGUAGES } shader_language;

/// Makes a context current. @return false after a message: there is none
bool shader_context_open(shader_language language);
void shader_context_close(void);

/// A program whose fragments are these parts, behind the lines that the language needs. Ends the
/// process after a message if it does not compile.
GLuint shader_program(shader_language language, const char *const *parts, int count);
/// A texture of a unit, in two or three dimensions, which is read by texel.
GLuint shader_texture(GLenum target, int unit);
/// Draws `width` fragments side by side into floats. @param rgba [width][4] out
void shader_run(int width, float *rgba);

#endif
