// SPDX-License-Identifier: MIT
// Kinds of light: the table (alp_light_traits, in light_kinds.c) that readers, writers, doctor and
// command read. A new kind needs a constant of alp_light_kind (alpenglow/scene.h), a row of the
// table, its light at a point (lighting_punctual.c, or lighting_suns.c where it has a size), and
// whatever a file stores of it beyond the traits (gltf_lights.c, gltf_export.c, collada_lights.c).
#ifndef ALPI_SCENE_LIGHT_KINDS_H
#define ALPI_SCENE_LIGHT_KINDS_H

#include "scene/scene.h"

/// Finds a kind by its name in the table. @return false: no kind has that name
bool alpi_light_kind_named(const char *name, alp_light_kind *kind);

/// Puts a light at a node: at its origin, shining along its −Z.
/// @return false: the transform gives no position, or no direction though the kind has one
bool alpi_light_place(alpi_light *light, const mat4 *world);

#endif
