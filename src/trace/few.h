// SPDX-License-Identifier: MIT
// Rays against few triangles: every packet meets all that it may reach. Where these are a dozen or
// two, looking for them in a hierarchy takes longer than meeting them.
#ifndef ALPI_TRACE_FEW_H
#define ALPI_TRACE_FEW_H

#include "trace/trace.h"

enum {
    ALPI_FEW_LIMIT = 64,                 // triangles at most
    ALPI_FEW_EDGES = 3 * ALPI_FEW_LIMIT, // and corners
    // Where a hierarchy would be as fast, measured in rooms of 12 to 60 triangles: polygons within
    // reach of a point, in the mean over all surfaces, for rays that are only asked whether they
    // are blocked; edges of all, for those that are asked for the nearest hit.
    ALPI_FEW_NEAR = 10,
    ALPI_FEW_NEAREST = 64
};

struct alpi_few;

/// The loops, compiled for any machine, for x86-64-v3 and, two packets at a time, for x86-64-v4. No
/// fused operations in any: the same bits. The last take 105 KB of stack.
typedef struct alpi_few_loops {
    /// As alpi_trace_occluded. @param lanes all ones for those that take part, 0 for the others
    void (*occluded)(const struct alpi_few *few, alpi_rays *packets, uint32_t count,
                     const uint32_t lanes[ALPI_PACKET], bool one_sided);
    /// As alpi_trace_nearest_many.
    void (*nearest)(const struct alpi_few *few, const alpi_rays *const *packets,
                    const uint32_t *active, uint32_t count, bool one_sided, alpi_hits *hits);
} alpi_few_loops;

extern const alpi_few_loops alpi_few_loops_baseline, alpi_few_loops_v3, alpi_few_loops_v4;

/// Of edges or corners: bit i % 64 of word i / 64.
typedef struct alpi_few_set {
    uint64_t words[ALPI_FEW_EDGES / 64];
} alpi_few_set;

typedef struct alpi_few_edge {
    uint16_t from, to; // corners
} alpi_few_edge;

/// A triangle, or two that make a flat convex quadrilateral, which is met as one. Its sides are
/// numbered from 0, side k from its corner k to the next; 4 is its diagonal, from corner 1 to
/// corner 3.
typedef struct alpi_few_polygon {
    float normal[3];   // not unit: twice its area; of a triangle (b − a) × (c − a)
    uint16_t corner;   // its corner 0
    uint16_t sides[4]; // counter-clockwise: twice the edge, and 1 more where that runs the other
                       // way. A triangle's last one twice
    alpi_few_edge diagonal; // of a triangle: from a corner to itself
    uint32_t triangles[2];  // of the scene: with corner 0, and with corner 2; or the same twice
    uint8_t weights[2][3];  // of each of the two: by which of sides and diagonal its corners weigh
    bool single_sided;
    alpi_few_set edges, corners; // that it has
} alpi_few_polygon;

/// Polygons that rays may reach, the edges of these, and the corners of those.
typedef struct alpi_few_list {
    uint32_t polygon_count, edge_count, corner_count;
    uint16_t polygons[ALPI_FEW_LIMIT], edges[ALPI_FEW_EDGES], corners[ALPI_FEW_EDGES];
} alpi_few_list;

/// Triangles as the loops want them. All of them are solid. Corners and edges are there once, so
/// that no two polygons with an edge in common can disagree on which side of it a ray passes.
typedef struct alpi_few {
    const alpi_few_loops *loops;                             // those for this machine
    uint32_t count, corner_count, edge_count, polygon_count; // count: of triangles
    float slack;  // metres, added to a ray's reach: far more than rounding may add to it, but where
                  // the ray grazes what it meets
    float extent; // metres: the longest side of the box about all
    float corner[ALPI_FEW_EDGES][3];
    alpi_few_edge edge[ALPI_FEW_EDGES];
    uint16_t corners[ALPI_FEW_LIMIT][3]; // of triangles
    alpi_few_polygon polygon[ALPI_FEW_LIMIT];
    float low[3][ALPI_FEW_LIMIT]; // bounding boxes of polygons; past the last: empty ones
    float high[3][ALPI_FEW_LIMIT];
    alpi_few_list all;
} alpi_few;

/// @param triangles [count] of the scene, usable and solid
/// @param few       out: to be released by its owner; NULL where they are too many, none, or of too
///                  different sizes
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_few_create(const alp_scene *scene, const uint32_t *triangles, uint32_t count,
                           alpi_few **few);

/// Boxes of polygons within `reach` of a point of them, in the mean over their area.
float alpi_few_near(const alpi_few *few, float reach);

#endif
