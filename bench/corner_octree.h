// SPDX-License-Identifier: MIT
// The first structure of 2006: an octree whose cells have their data in corners. Slow and plain, as
// a measure for the graph of the ambience volume.
//
// Corners lie on an integer lattice, so that neighbours share them exactly. Each frame, the cells
// that hold the camera, from the root to the leaf, get their missing corners. Then those round them
// do, level by level, as far as the budget goes. Look-ups are trilinear in the finest cell that has
// all corners; corners in solids count for nothing.
#ifndef CORNER_OCTREE_H
#define CORNER_OCTREE_H

#include "ambience_world.h"

typedef struct corner_octree corner_octree;

/// Memory or the end of the program. @param size metres along an edge of the root, about `centre`
corner_octree *corner_octree_create(const double centre[3], double size, uint32_t depth);
void corner_octree_destroy(corner_octree *octree);
/// Samples missing corners. @param samples at most
bool corner_octree_step(corner_octree *octree, const ambience_world *world,
                        const alp_ambience_snapshot *bounced, const double camera[3],
                        uint32_t samples);
void corner_octree_read(const corner_octree *octree, uint32_t count, const double (*positions)[3],
                        const float (*normals)[3], float (*values)[3]);

typedef struct corner_octree_counts {
    uint32_t corners, cells;
} corner_octree_counts;
/// Corners with data, and cells that have eight children with all their corners.
corner_octree_counts corner_octree_count(const corner_octree *octree);

#endif
