// SPDX-License-Identifier: MIT
// The object of --object on the graphics card. It moves, and it is lit where it stands.
#ifndef VIEWER_GL_OBJECT_H
#define VIEWER_GL_OBJECT_H

#include "gl/gl_field.h"
#include "gl/gl_scene.h"

#include <alpenglow/render.h>

typedef struct gl_object {
    alp_render_object what; // kind NONE: there is no object, and the rest is empty
    alp_scene *scene;       // its triangles where it stands
    gl_scene drawn;
    gl_field field; // a reader of the mode's
} gl_object;

/// Puts an object somewhere, or puts it elsewhere.
/// @param object           empty, or from the call before
/// @param first_triangle   its number in pictures of triangles
/// @return EXIT_DONE, or EXIT_FAILED after a message; gl_object_destroy in both cases
int gl_object_place(alp_context *context, const alp_render_object *what, uint32_t first_triangle,
                    gl_object *object);
void gl_object_destroy(gl_object *object);
/// The triangles that are drawn beside the scene, or NULL.
const gl_scene *gl_object_drawn(const gl_object *object);
/// Reads the field of a mode for the object, if it or the light has changed. To be called before
/// gl_field_update of the mode's.
void gl_object_update(gl_object *object, const gl_field *light);

#endif
