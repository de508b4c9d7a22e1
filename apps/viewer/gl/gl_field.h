// SPDX-License-Identifier: MIT
// A field of light on the graphics card, by the places where it is read: pixels, vertices or
// objects.
#ifndef VIEWER_GL_FIELD_H
#define VIEWER_GL_FIELD_H

#include <alpenglow/field.h>

#include "gl/gl_lpv.h"
#include "gl/gl_probes.h"

#include <epoxy/gl.h>

#include <stdbool.h>

typedef struct gl_field {
    const alp_field *field; // borrowed; NULL: the mode has none
    GLint read;             // READ_… of bindings.h
    uint32_t workers;       // threads that look it up
    bool changed;           // since vertices and objects were read
    GLuint vertices;        // BUFFER_FIELD_VERTICES
    GLuint objects;         // BUFFER_FIELD_OBJECTS
    GLuint pixels;          // TEXTURE_FIELD; pass_field fills it
    gl_probes probes;       // of READ_PROBES
    const gl_lpv *volume;   // borrowed, of READ_LPV
    bool gloss;             // surfaces mirror its light
} gl_field;

/// Makes what a kind of reading needs.
/// @param read  READ_PIXEL, READ_VERTEX or READ_OBJECT
/// @param width, height of pictures
/// @return EXIT_DONE, or EXIT_FAILED after a message; gl_field_destroy in both cases
int gl_field_create(const alp_scene *scene, GLint read, uint32_t width, uint32_t height,
                    gl_field *drawn);
void gl_field_destroy(gl_field *drawn);

/// Makes a reader of the same field for the scene of an object, with vertices and surfaces of its
/// own.
/// @param of what the reader follows: gl_field_follow before each update
void gl_field_create_reader(const alp_scene *scene, const gl_field *of, gl_field *reader);
/// Takes over the field, and all of it that is not of vertices and surfaces.
void gl_field_follow(gl_field *reader, const gl_field *of);
void gl_field_destroy_reader(gl_field *reader);

/// Sets the field from now on, or tells that it holds other light.
void gl_field_set(gl_field *drawn, const alp_field *field);
/// Reads probes in the shader from now on, as their field of ALP_LOOKUP_OURS does, if they can be
/// and pixels are read.
/// @param origin of the scene in the world of its file
void gl_field_set_probes(gl_field *drawn, const alp_probes *probes, const double origin[3]);
/// Reads a volume on the card from now on.
void gl_field_set_volume(gl_field *drawn, const gl_lpv *volume, bool gloss);
/// Reads the field at vertices or objects, if it has changed.
void gl_field_update(gl_field *drawn, const alp_scene *scene);
/// Binds buffers and textures, and sets the uniforms of the current program.
/// @param program the current one
void gl_field_bind(const gl_field *drawn, GLuint program);

#endif
