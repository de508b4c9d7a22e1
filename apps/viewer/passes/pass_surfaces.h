// SPDX-License-Identifier: MIT
// Draws surfaces: the nearest opaque ones, and panes before them layer by layer.
#ifndef VIEWER_PASS_SURFACES_H
#define VIEWER_PASS_SURFACES_H

#include "camera_view.h"
#include "gl/gl_scene.h"
#include "gl/gl_targets.h"
#include "view_modes.h"

typedef struct pass_surfaces {
    GLuint program, query;
    const view_mode *mode;
    bool metals_black;
} pass_surfaces;

/// @return EXIT_DONE, or EXIT_FAILED after a message; pass_surfaces_destroy in both cases
int pass_surfaces_create(const view_mode *mode, bool metals_black, pass_surfaces *pass);
void pass_surfaces_destroy(pass_surfaces *pass);
/// Whether panes are drawn apart; else surfaces of all kinds are opaque.
bool pass_surfaces_has_panes(const pass_surfaces *pass, const gl_scene *scene);
/// Draws the nearest opaque surfaces into opaque_frame. @param light NULL of modes without bind
void pass_surfaces_draw_opaque(const pass_surfaces *pass, const gl_scene *scene,
                               const mode_light *light, const camera_view *view,
                               const gl_targets *targets);
/// Adds a closed or single-sided object without panes to them: its fronts, as render shows it.
void pass_surfaces_add_object(const pass_surfaces *pass, const gl_scene *object,
                              const mode_light *light, const camera_view *view,
                              const gl_targets *targets);
/// Draws a layer of panes before the opaque surfaces into layer_frames[layer % 2].
/// @param layer its number, from 0
/// @return whether it shows anything
bool pass_surfaces_draw_panes(const pass_surfaces *pass, const gl_scene *scene,
                              const mode_light *light, const camera_view *view,
                              const gl_targets *targets, uint32_t layer);

#endif
