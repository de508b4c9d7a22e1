// SPDX-License-Identifier: MIT
// Which surfaces of a scene are meant: by the patterns of their names, and which of them are one
// mesh placed several times.
#ifndef ALPI_SCENE_SELECT_H
#define ALPI_SCENE_SELECT_H

#include "scene/scene.h"

/// The surfaces whose name (of the node, else of the mesh, else "node N": all primitives of a node
/// have the same) is matched by one of the patterns: several with commas between, see base/glob.h.
/// @param pattern  NULL = all
/// @param surfaces out: [surface_count], released by the caller; NULL when pattern is
/// @return ALP_OK; INVALID_ARGUMENT: one of the patterns matches nothing; the message has the names
///         that there are; OUT_OF_MEMORY
alp_result alpi_scene_select(const alp_scene *scene, const char *pattern, bool **surfaces);

/// For every surface the one that it is an instance of. Nodes with the same mesh are instances of
/// that one among them that has most usable triangles, of equals the first; a surface that is no
/// instance, or not chosen, has itself. Either all chosen primitives of a node are instances of
/// those of one other node, or none is.
/// @param surfaces  the chosen ones, NULL = all
/// @param originals out: [surface_count], released by the caller
alp_result alpi_scene_instances(const alp_scene *scene, const bool *surfaces, uint32_t **originals);

#endif
