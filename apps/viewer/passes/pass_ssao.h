// SPDX-License-Identifier: MIT
// Screen-space ambient occlusion: the share of ambient light that the surfaces in the picture leave
// open, within a radius.
// Based on: M. Mittring. Finding Next Gen: CryEngine 2. SIGGRAPH 2007. Here directions have the
// density of the cosine in the hemisphere of the normal, and a surface occludes a point only where
// it rises above the point's plane.
#ifndef VIEWER_PASS_SSAO_H
#define VIEWER_PASS_SSAO_H

#include "passes/pass_surfaces.h"
#include "passes/screen_pass.h"

typedef struct pass_ssao {
    pass_surfaces places;
    screen_pass occlude, blur;
    GLuint seen;         // RGBA32F: normal of the nearest opaque triangle, and its distance
    GLuint noisy, share; // R32F: share that is open, before and after the blur
    GLuint noisy_frame, frame;
    float radius; // metres
} pass_ssao;

/// @param panes  whether panes are drawn apart, and occlude nothing
/// @param radius metres
/// @return EXIT_DONE, or EXIT_FAILED after a message; pass_ssao_destroy in both cases
int pass_ssao_create(const gl_targets *targets, bool panes, float radius, pass_ssao *pass);
void pass_ssao_destroy(pass_ssao *pass);
/// Fills `share` for a view. Draws over the targets of opaque surfaces.
void pass_ssao_draw(const pass_ssao *pass, const gl_scene *scene, const camera_view *view,
                    const gl_targets *targets);

#endif
