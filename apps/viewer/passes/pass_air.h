// SPDX-License-Identifier: MIT
// Draws mist between layers of surfaces: the light of a volume and of lamps that it scatters.
#ifndef VIEWER_PASS_AIR_H
#define VIEWER_PASS_AIR_H

#include "camera_view.h"
#include "gl/gl_lights.h"
#include "gl/gl_lpv.h"
#include "passes/screen_pass.h"

/// @return EXIT_DONE, or EXIT_FAILED after a message; screen_pass_destroy in both cases
int pass_air_create(screen_pass *pass);

typedef struct mist {
    float scattering; // 1/metre
    const gl_lpv *volume;
    const gl_lights *lights;
    const alp_scene_info *info;
} mist;
/// Adds the mist between two layers behind the sum, as pass_layers_add adds a layer.
/// @param before, end depths of the two; before 0: from the camera on
/// @param step        number of layers and mists so far
void pass_air_draw(const screen_pass *pass, const mist *m, const camera_view *view,
                   const gl_targets *targets, GLuint before, GLuint end, uint32_t step);

#endif
