// SPDX-License-Identifier: MIT
// The built-in scenes, one function each. Metres, +Y up.
#ifndef ALPI_SCENE_BUILTIN_H
#define ALPI_SCENE_BUILTIN_H

#include "scene/mesh_builder.h"

/// The Cornell box, as measured at Cornell University.
void alpi_builtin_cornell(alpi_builder *builder);

// Scenes with a closed form (builtin_closed_forms.c).

/// A closed unit cube [0, 1]³ seen from inside: albedo .5, emission of radiance 1 W·sr⁻¹·m⁻², so
/// that the radiance is 2 everywhere and in every direction.
void alpi_builtin_furnace(alpi_builder *builder);
/// Inside of a unit sphere about the origin, cut at y = .5: openness (1 − .5)/2 at every point.
void alpi_builtin_bowl(alpi_builder *builder);
/// A sphere of radius .5 that rests on a 4 m × 4 m plane at y = 0.
void alpi_builtin_sphere_plane(alpi_builder *builder);
/// A torus of radii .6 and .25 that lies on a 4 m × 4 m plane at y = 0.
void alpi_builtin_torus_plane(alpi_builder *builder);

/// Newell's teapot on a table, in a furnished room of 4 m × 2.8 m × 4 m.
void alpi_builtin_teapot_room(alpi_builder *builder);

#endif
