// SPDX-License-Identifier: MIT
// Overlapping charts: a triangle lies in one chart for each axis that its normals have a part of.
// Based on: I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU, 2007.
#ifndef ALPI_ATLAS_BLEND_H
#define ALPI_ATLAS_BLEND_H

#include "atlas/stages.h"
#include "scene/blend_weights.h"

enum { ALPI_BLEND_SETS = 3 };

/// alpi_surface_weights in the frame of the atlas.
void alpi_blend_weights(const alp_atlas *atlas, uint32_t triangle, float b1, float b2,
                        float weights[ALPI_BLEND_SETS]);

/// How much of what is read at a point of a triangle comes from the chart of one of its faces.
float alpi_blend_share(const alp_atlas *atlas, uint32_t face, const float barycentrics[2]);

/// A triangle's place in a chart of an axis.
typedef struct alpi_blend_face {
    uint32_t triangle;
    uint8_t axis;
    bool negative; // it faces against the axis
    float cosine;  // of its plane to the axis' plane, (0, 1]
} alpi_blend_face;

/// What the clusters are grown from.
typedef struct alpi_blend_faces {
    uint32_t count;
    alpi_blend_face *faces;    // [count] those of triangle t < triangle_count first, one each
    uint32_t (*neighbours)[3]; // [count] of the same axis and side, or ALPI_NONE
} alpi_blend_faces;

/// Clusters of faces that are projected along one axis without folding. Grown from the faces that
/// lie flattest, breadth-first through bands of like steepness, so that a fold cuts where they are
/// steep and the weight of the axis is small.
/// @param view a scene whose triangles are the faces
alp_result alpi_blend_clusters(const alp_scene *view, const alpi_blend_faces *faces, bool world,
                               alpi_atlas_clock *clock, alpi_clusters *clusters);

/// Charts that are to lie on one page, so that triangles keep all that they are in: joined where
/// they share triangles, what weighs most first, as long as they likely fit a page.
/// @param items as they are packed, [charts->count]
/// @param groups out: [charts->count] of each, less than that; released by the caller
alp_result alpi_blend_groups(const alp_atlas *atlas, const alpi_charts *charts,
                             const alpi_pack_item *items, uint32_t **groups);

/// All stages of ALP_ATLAS_BLEND but the coordinates of what has no area.
alp_result alpi_blend_build(alp_atlas *atlas, const uint32_t (*neighbours)[3],
                            alpi_atlas_clock *clock);
/// Fills set_uvs, after all else.
void alpi_blend_fill_sets(alp_atlas *atlas);

#endif
