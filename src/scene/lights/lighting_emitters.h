// SPDX-License-Identifier: MIT
// The emissive triangles of a scene, and draws of one by the hierarchy over them.
#ifndef ALPI_SCENE_LIGHTING_EMITTERS_H
#define ALPI_SCENE_LIGHTING_EMITTERS_H

#include "scene/lights/light_tree.h"
#include "scene/scene.h"

typedef struct alpi_emitters {
    uint32_t count;
    uint32_t *triangles;   // [count], ascending
    alpi_light_tree *tree; // NULL where there are none
    double largest;        // radiance, mean of the channels, of the brightest triangle
} alpi_emitters;

/// Usable triangles whose material emits, less those over black of its texture. The power of each
/// is its area times the mean of a few looks at the texture, and never 0. What was made is released
/// by alpi_emitters_clear, also after a failure.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_emitters_collect(const alp_scene *scene, alpi_emitters *emitters);
void alpi_emitters_clear(alp_context *context, alpi_emitters *emitters);

/// Radiance of an emissive triangle, mean over it (by a few looks at its texture, but never 0) and
/// over the channels; 0 where its material emits nothing.
double alpi_emitters_radiance(const alp_scene *scene, uint32_t triangle);

/// Place of a triangle in `triangles`, ALPI_NONE if it is none of them.
uint32_t alpi_emitters_find(const alpi_emitters *emitters, uint32_t triangle);

#endif
