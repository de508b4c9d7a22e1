// SPDX-License-Identifier: MIT
// Newell's teapot as triangles.
#ifndef ALPI_SCENE_TEAPOT_H
#define ALPI_SCENE_TEAPOT_H

#include "scene/builtin/mesh_builder.h"

enum { ALPI_TEAPOT_PATCHES = 32 };
/// Height of the published data: from the bottom to the top of the lid's knob.
#define ALPI_TEAPOT_HEIGHT 3.15f

typedef struct alpi_teapot {
    vec3 foot;         // where the middle of the bottom stands
    float height;      // metres
    float turn;        // radians about +y; 0: the spout points to +x
    uint32_t segments; // per patch edge, at least 1
} alpi_teapot;

/// Adds 32 patches of segments × segments quads (triangles at the two poles) to the surface that
/// was begun. Normals are analytic and point outside. Patches that share an edge give it the same
/// floats; the published gaps stay: between body and lid, and where handle and spout end inside or
/// on the body and at the spout's mouth.
void alpi_builder_teapot(alpi_builder *builder, const alpi_teapot *teapot);

#endif
