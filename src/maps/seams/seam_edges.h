// SPDX-License-Identifier: MIT
// Where a surface goes on across edges of triangles though its texture coordinates do not.
//
// Edges meet where they run along each other in opposite directions: shared edges of a mesh between
// two charts, tiles that stand side by side, T-junctions. Those with the same ends meet without any
// tolerance, wherever they lie; what is left over meets whole or in part, within a tenth of a texel
// and at most a quarter where coordinates are rounded. Nothing is asked about who shares which
// vertex.
#ifndef ALPI_MAPS_SEAM_EDGES_H
#define ALPI_MAPS_SEAM_EDGES_H

#include "maps/lightmap.h"

/// An edge of a triangle, from its corner `half_edge % 3` to the next.
typedef struct alpi_seam_edge {
    uint32_t half_edge; // 3 · triangle + corner
    float length;       // metres
    float texel;        // metres: of a texel along it, at most its length
} alpi_seam_edge;

typedef struct alpi_seam_edges {
    alp_context *context;
    uint32_t count;
    alpi_seam_edge *edges; // [count] by half-edges
} alpi_seam_edges;

/// Two edges that meet along a segment, as shares of their lengths from their first corners.
typedef struct alpi_seam_pair {
    alpi_seam_edge edges[2];
    double begins[2], ends[2];
    double length; // metres of the segment
} alpi_seam_pair;

/// The least cosine between shading normals where a surface goes on: of 3°. Across an edge that is
/// sharper light steps by itself, by as much as the angle's sine of what arrives, and must not be
/// evened out; normals of eight bits are 0.6° off.
#define ALPI_SEAM_COSINE 0.99863

/// The edges at which a look-up does not go on as it should: those of triangles on pages, but for
/// edges where the neighbour's coordinates and shading normals are the same.
alp_result alpi_seam_edges_create(const alp_lightmap *lightmap, alpi_seam_edges *edges);
void alpi_seam_edges_destroy(alpi_seam_edges *edges);

/// Gets each pair once, in an order that is always the same.
typedef alp_result alpi_seam_pair_fn(void *user, const alpi_seam_pair *pair);
/// Finds the edges that meet. An edge looks at no more than 4096 others of about one length about
/// one place. @return ALP_OK; OUT_OF_MEMORY; CANCELLED; what `each` says
alp_result alpi_seam_pairs_visit(const alp_scene *scene, const alpi_seam_edges *edges,
                                 alpi_seam_pair_fn *each, void *user);

#endif
