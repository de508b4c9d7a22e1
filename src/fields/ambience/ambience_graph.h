// SPDX-License-Identifier: MIT
// The graph of the ambience volume: nodes of 3 × 3 × 3 children over an integer lattice.
//
// Lengths are in units, the cell of level 0. A node of level l and index i is a cube of 3^l units
// about the place 3^l i. Its children have level l − 1 and the indices 3 i + {−1, 0, 1}³. The
// middle child has its parent's place and shares its anchor. So all places are integers, and
// neighbouring cells meet exactly.
//
// The root begins at level `depth`. It grows where something outside is wanted, and shrinks back.
// Nodes above level `depth` have no anchors.
//
// All children of a node are made and removed together. Links between neighbours of a level are
// kept in pairs. A flat graph has 9 children, at index 0 of y.
//
// Based on: C. Nilsson, A. Jansson. Ljussättning i realtid med dynamisk ambiansvolym. Chalmers,
//           2006: SHGraph.
#ifndef ALPI_FIELDS_AMBIENCE_GRAPH_H
#define ALPI_FIELDS_AMBIENCE_GRAPH_H

#include "base/context.h"

#define ALPI_NO_NODE UINT32_MAX
#define ALPI_NO_ANCHOR UINT32_MAX

enum {
    ALPI_GRAPH_CHILDREN = 27,
    ALPI_GRAPH_LEVELS = 19,    // 3^18 units across fit in an index
    ALPI_GRAPH_DIRECTIONS = 6, // −x +x −y +y −z +z
    ALPI_GRAPH_ROOT = 0        // node; other numbers change with the root, and by compaction
};

typedef struct alpi_graph_node {
    int32_t index[3];
    uint32_t parent; // NO_NODE: the root
    uint32_t child;  // the first of its children, which follow each other x fastest; NO_NODE: none
    uint32_t neighbour[ALPI_GRAPH_DIRECTIONS]; // of its level; NO_NODE: none
    uint32_t anchor;                           // NO_ANCHOR: none
    uint32_t used; // bit c: child c has an anchor that is not this node's, or has descendants with
                   // one
    uint8_t level, place; // place: which child of its parent
} alpi_graph_node;

typedef struct alpi_graph {
    alp_context *context;
    bool flat;
    uint32_t depth; // least level of the root, and the highest with anchors
    uint32_t node_limit;
    alpi_graph_node *nodes; // in blocks of CHILDREN; of the first block, the root alone is used
    size_t node_capacity;
    uint32_t node_end;   // nodes below it were handed out
    uint32_t free_block; // list through `child` of the first nodes; NO_NODE: none
    uint32_t node_count; // in use
} alpi_graph;

/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_graph_create(alp_context *context, bool flat, uint32_t depth, uint32_t node_limit,
                             alpi_graph *graph);
void alpi_graph_destroy(alpi_graph *graph);

/// The node that holds a place at a level. @param index of the node @return NO_NODE: none
uint32_t alpi_graph_find(const alpi_graph *graph, uint32_t level, const int32_t index[3]);
/// Whether a node may lie below the root as it is.
bool alpi_graph_reaches(const alpi_graph *graph, uint32_t level, const int32_t index[3]);
/// The same node; made, and the root grown, where it is missing.
/// @param node out: NO_NODE where the limit of nodes or of levels is reached
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_graph_require(alpi_graph *graph, uint32_t level, const int32_t index[3],
                              uint32_t *node);

/// The topmost node of the same place, up to level `depth`: it owns the anchor.
uint32_t alpi_graph_top(const alpi_graph *graph, uint32_t node);
/// Gives an anchor (or NO_ANCHOR) to a node and all others of its place.
void alpi_graph_set_anchor(alpi_graph *graph, uint32_t node, uint32_t anchor);

/// Removes children without anchors of their own, and shrinks the root to its only used child, down
/// to its least level.
void alpi_graph_prune(alpi_graph *graph);
/// Moves nodes from the end of the pool to free places, and gives memory back. Numbers of nodes
/// change. @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_graph_compact(alpi_graph *graph);

/// Children of a node.
static inline uint32_t alpi_graph_child_count(bool flat)
{
    return flat ? 9 : ALPI_GRAPH_CHILDREN;
}
/// The middle child.
static inline uint32_t alpi_graph_middle(bool flat)
{
    return flat ? 4 : 13;
}
/// 3^level.
static inline int64_t alpi_graph_width(uint32_t level)
{
    int64_t width = 1;
    for (uint32_t i = 0; i < level; i++) {
        width *= 3;
    }
    return width;
}
/// The index of the parent: round(i / 3).
static inline int32_t alpi_graph_parent_index(int32_t index)
{
    const int64_t up = (int64_t)index + 1;
    return (int32_t)(up >= 0 ? up / 3 : -((2 - up) / 3));
}

#endif
