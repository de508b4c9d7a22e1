// SPDX-License-Identifier: MIT
// Reads a field at the pixels of surfaces: draws positions and normals, and looks them up.
#ifndef VIEWER_PASS_FIELD_H
#define VIEWER_PASS_FIELD_H

#include "gl/gl_field.h"
#include "passes/pass_surfaces.h"

typedef struct pass_field {
    pass_surfaces points;
    // [pixel] as of the targets: positions and whether there is one, normals; then irradiance.
    float (*position_picture)[4], (*normal_picture)[4];
    // [pixel] those alone that show a surface
    float (*positions)[3], (*normals)[3], (*irradiance)[3];
} pass_field;

/// @return EXIT_DONE, or EXIT_FAILED after a message; pass_field_destroy in both cases
int pass_field_create(const gl_targets *targets, pass_field *pass);
void pass_field_destroy(pass_field *pass);
/// Fills the texture of a field that is read at pixels, for the nearest opaque surfaces. The
/// targets are those of pass_surfaces, which draws the same next.
/// @param object beside the scene, or NULL
void pass_field_draw_opaque(const pass_field *pass, const gl_field *field, const gl_scene *scene,
                            const gl_scene *object, const camera_view *view,
                            const gl_targets *targets);
/// The same for a layer of panes. @return whether it shows anything
bool pass_field_draw_panes(const pass_field *pass, const gl_field *field, const gl_scene *scene,
                           const camera_view *view, const gl_targets *targets, uint32_t layer);

#endif
