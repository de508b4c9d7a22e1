// SPDX-License-Identifier: MIT
// Triangles that lean little from one axis, gathered bottom-up; and how sharp an edge is.
#ifndef ALPI_ATLAS_REGIONS_H
#define ALPI_ATLAS_REGIONS_H

#include "scene/scene.h"

/// No region crosses what is sharper, in radians (45°): it would be seen in a texel that holds both
/// sides.
#define ALPI_SHARPEST_CREASE 0.79f

/// Connected triangles of one node whose normals lie in a cone. They may fold over themselves.
typedef struct alpi_regions {
    uint32_t *of_triangle; // [triangle_count] the region's name, that of a triangle which it had
    float (*planes)[3];    // [triangle_count] unit normal of the plane of the region that has this
                           // triangle in of_triangle
} alpi_regions;

/// Regions of all usable triangles: neighbours are merged, those first that add least to the cone,
/// the outline and the creases inside, as long as all normals stay within max_angle of the plane
/// that the region is projected on. O(n log n).
alp_result alpi_regions_create(const alp_scene *scene, const uint32_t (*neighbours)[3],
                               float max_angle, alpi_regions *regions);
/// Makes the borders of regions shorter: triangles that jut out go over to the region beside them.
/// No region falls apart, and no triangle leans more than max_angle from its region's plane. Where
/// light steps, a border counts less. Linear in triangles.
alp_result alpi_regions_straighten(const alp_scene *scene, const uint32_t (*neighbours)[3],
                                   float max_angle, alpi_regions *regions);
void alpi_regions_destroy(alp_context *context, alpi_regions *regions);

/// Whether one node shows both triangles, in one instance of its mesh.
bool alpi_share_node(const alp_scene *scene, uint32_t a, uint32_t b);
/// The edge of the triangle across edge k that is this one. Two triangles may have two in common.
int alpi_edge_back(const alp_scene *scene, const uint32_t (*neighbours)[3], uint32_t triangle,
                   int k);
/// How sharply the light steps across edge k of a triangle that has a neighbour there: the angle
/// between the shading normals on its two sides, or the fold of the surface where that is more than
/// normals of a round surface hide. Radians, 0 on a smooth surface.
float alpi_crease(const alp_scene *scene, const uint32_t (*neighbours)[3], uint32_t triangle,
                  int k);

#endif
