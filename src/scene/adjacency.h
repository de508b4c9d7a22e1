// SPDX-License-Identifier: MIT
// Which triangle lies across each edge of each triangle.
#ifndef ALPI_SCENE_ADJACENCY_H
#define ALPI_SCENE_ADJACENCY_H

#include "scene/scene.h"

/// neighbours[t][k] = triangle across edge (corner k, corner k+1), or ALPI_NONE: border, unusable,
/// or an edge where it cannot be told. If more than two triangles share an edge, those of one
/// node are paired by their winding, the nearest normals first, if as many run one way as the
/// other. Vertices are equal where their positions are (−0 equals +0). Linear in triangles: hashed.
/// [triangle_count][3], released by the caller.
alp_result alpi_adjacency_create(const alp_scene *scene, uint32_t (**neighbours)[3]);

#endif
