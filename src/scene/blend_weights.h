// SPDX-License-Identifier: MIT
// With which weights maps along the three axes of an object are read: the squares of the unit
// normal's components in its frame.
// Based on: I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU, 2007,
// chapter 7.5.
#ifndef ALPI_SCENE_BLEND_WEIGHTS_H
#define ALPI_SCENE_BLEND_WEIGHTS_H

#include "scene/scene.h"

/// The axes of a surface's object, world, unit; the world's own where it asks for those or where
/// the object's lie too near one plane to project on.
void alpi_surface_axes(const alpi_surface *surface, bool world, vec3 axes[3]);

/// The axes that a world normal is multiplied by for its components in the frame of the object: of
/// their own lengths, or the world's as above.
void alpi_surface_normal_axes(const alpi_surface *surface, float axes[3][3]);

/// n_k² of the unit normal in the frame of the triangle's object, interpolated between its corners
/// as a shader does; they sum to 1.
void alpi_surface_weights(const alp_scene *scene, bool world, uint32_t triangle, float b1, float b2,
                          float weights[3]);

#endif
