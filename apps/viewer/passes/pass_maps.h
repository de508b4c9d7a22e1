// SPDX-License-Identifier: MIT
// Draws reflective shadow maps: positions, normals and reflected flux of what a light sees.
#ifndef VIEWER_PASS_MAPS_H
#define VIEWER_PASS_MAPS_H

#include "gl/gl_lights.h"
#include "gl/gl_lpv.h"
#include "gl/gl_scene.h"

typedef struct pass_maps {
    GLuint program, frame, depth;
    gl_lpv_map map; // what was drawn last; its cascade is the caller's
} pass_maps;

/// @param side of the map, texels
/// @return EXIT_DONE, or EXIT_FAILED after a message; pass_maps_destroy in both cases
int pass_maps_create(uint32_t side, pass_maps *pass);
void pass_maps_destroy(pass_maps *pass);
/// Draws a map of the view's size, at most that of pass_maps_create. Texels beyond it are empty.
/// @param object beside the scene, or NULL
/// @param light number in `lights` whose flux is reflected; MAP_NO_LIGHT: no flux
void pass_maps_draw(const pass_maps *pass, const gl_scene *scene, const gl_scene *object,
                    const gl_lights *lights, uint32_t light, bool metals_black,
                    const camera_view *view);

#endif
