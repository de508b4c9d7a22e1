// SPDX-License-Identifier: MIT
// Adds layers of surfaces to a picture, from front to back, so that panes are drawn in their order
// without sorting triangles.
// Based on: C. Everitt. Interactive order-independent transparency. NVIDIA 2001 (depth peeling).
#ifndef VIEWER_PASS_LAYERS_H
#define VIEWER_PASS_LAYERS_H

#include "passes/screen_pass.h"

typedef struct pass_layers {
    screen_pass screen;
} pass_layers;

/// @return EXIT_DONE, or EXIT_FAILED after a message; pass_layers_destroy in both cases
int pass_layers_create(pass_layers *pass);
void pass_layers_destroy(pass_layers *pass);
/// Empties the sum.
void pass_layers_clear(const gl_targets *targets);
/// Adds a layer behind the sum.
/// @param light, through of the layer
/// @param step           number of layers and mists so far; the share that is left behind the layer
///                       goes to lefts[1 - step % 2]
void pass_layers_add(const pass_layers *pass, const gl_targets *targets, GLuint light,
                     GLuint through, uint32_t step);

#endif
