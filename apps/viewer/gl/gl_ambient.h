// SPDX-License-Identifier: MIT
// An ambient model on the graphics card.
#ifndef VIEWER_GL_AMBIENT_H
#define VIEWER_GL_AMBIENT_H

#include <alpenglow/field.h>

#include <epoxy/gl.h>

typedef struct gl_ambient {
    GLuint model; // BUFFER_AMBIENT
    GLint kind;   // an alp_ambient_model
} gl_ambient;

/// @param field of alp_field_create_ambient; not needed afterwards
void gl_ambient_create(const alp_field *field, gl_ambient *ambient);
void gl_ambient_destroy(gl_ambient *ambient);
/// Binds the buffer, and sets the uniform of the current program.
void gl_ambient_bind(const gl_ambient *ambient);

#endif
