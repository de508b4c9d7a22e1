// SPDX-License-Identifier: MIT
// A field of light on the graphics card, by the places where it is read: pixels, vertices or
// objects.
#ifndef VIEWER_GL_FIELD_H
#define VIEWER_GL_FIELD_H

#include <alpenglow/field.h>

#include <epoxy/gl.h>

#include <stdbool.h>

typedef struct gl_field {
    const alp_field *field; // borrowed; NULL: the mode has none
    GLint read;             // FIELD_… of bindings.h
    uint32_t workers;       // threads that look it up
    bool changed;           // since vertices and objects were read
    GLuint vertices;        // BUFFER_FIELD_VERTICES
    GLuint objects;         // BUFFER_FIELD_OBJECTS
    GLuint pixels;          // TEXTURE_FIELD; pass_field fills it
} gl_field;

/// Makes what a kind of reading needs.
/// @param read    FIELD_PIXEL, FIELD_VERTEX or FIELD_OBJECT
/// @param field   NULL, or the first; it and the next ones are given by gl_field_set
/// @param width, height of pictures
void gl_field_create(const alp_scene *scene, GLint read, uint32_t width, uint32_t height,
                     gl_field *drawn);
void gl_field_destroy(gl_field *drawn);

/// Sets the field from now on, or tells that it holds other light.
void gl_field_set(gl_field *drawn, const alp_field *field);
/// Reads the field at vertices or objects, if it has changed.
void gl_field_update(gl_field *drawn, const alp_scene *scene);
/// Binds buffers and textures, and sets the uniforms of the current program.
void gl_field_bind(const gl_field *drawn);

#endif
