// SPDX-License-Identifier: MIT
// The built-in scenes, one function each. Metres, +Y up.
#ifndef ALPI_SCENE_BUILTIN_H
#define ALPI_SCENE_BUILTIN_H

#include "scene/builtin/mesh_builder.h"

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

/// A room of 8 m × 4 m × 6 m with three windows, pillars and alcoves, and a small bright sun
/// outside.
void alpi_builtin_windows(alpi_builder *builder);

// Scenes of any size. `values` are the parameters in the order of the table in builtin.c.

/// Triangles a scene can be asked for, and has unless asked.
enum {
    ALPI_ATRIUM_LOW = 20000,
    ALPI_ATRIUM_STANDARD = 50000,
    ALPI_TERRAIN_LOW = 5000,
    ALPI_TERRAIN_STANDARD = 60000,
    ALPI_SIZED_HIGH = 4000000,
    ALPI_TREES_HIGH = 20000
};

/// A court of 16 m × 10 m between two storeys of arcades, open to the sky. values: triangles.
void alpi_builtin_atrium(alpi_builder *builder, const uint32_t *values);
/// Hills of 240 m × 240 m round a lake, with houses and trees. values: triangles; trees, ALPI_NONE
/// = as many as suit the triangles.
void alpi_builtin_terrain(alpi_builder *builder, const uint32_t *values);

#endif
