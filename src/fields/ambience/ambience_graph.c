// SPDX-License-Identifier: MIT
#include "fields/ambience/ambience_graph.h"

#include "base/memory.h"
#include "fields/ambience/ambience_lights.h"

#include <string.h>

// --- pool of blocks ------------------------------------------------------------------------------

static void clear_node(alpi_graph_node *node)
{
    memset(node, 0, sizeof *node);
    node->parent = node->child = ALPI_NO_NODE;
    node->anchor = ALPI_NO_ANCHOR;
    for (int d = 0; d < ALPI_GRAPH_DIRECTIONS; d++) {
        node->neighbour[d] = ALPI_NO_NODE;
    }
}

/// @param block out: its first node, or NO_NODE at the limit
static alp_result take_block(alpi_graph *g, uint32_t *block)
{
    const uint32_t count = alpi_graph_child_count(g->flat);
    *block = ALPI_NO_NODE;
    if (g->node_count + count > g->node_limit) {
        return ALP_OK;
    }
    if (g->free_block != ALPI_NO_NODE) {
        *block = g->free_block;
        g->free_block = g->nodes[*block].child;
    } else {
        ALP_TRY(alpi_grow_tightly(g->context, (void **)&g->nodes, &g->node_capacity,
                                  (size_t)g->node_end + count, sizeof *g->nodes));
        *block = g->node_end;
        g->node_end += count;
    }
    g->node_count += count;
    for (uint32_t i = 0; i < count; i++) {
        clear_node(&g->nodes[*block + i]);
    }
    return ALP_OK;
}

static void give_block(alpi_graph *g, uint32_t block)
{
    for (uint32_t i = 0; i < alpi_graph_child_count(g->flat); i++) {
        clear_node(&g->nodes[block + i]);
    }
    g->nodes[block].child = g->free_block;
    g->free_block = block;
    g->node_count -= alpi_graph_child_count(g->flat);
}

alp_result alpi_graph_create(alp_context *context, bool flat, uint32_t depth, uint32_t node_limit,
                             alpi_graph *graph)
{
    *graph = (alpi_graph){.context = context,
                          .flat = flat,
                          .depth = depth,
                          .node_limit = node_limit,
                          .free_block = ALPI_NO_NODE};
    ALP_TRY(alpi_grow(context, (void **)&graph->nodes, &graph->node_capacity, ALPI_GRAPH_CHILDREN,
                      sizeof *graph->nodes));
    graph->node_end = 1;
    graph->node_count = 1;
    clear_node(&graph->nodes[ALPI_GRAPH_ROOT]);
    graph->nodes[ALPI_GRAPH_ROOT].level = (uint8_t)depth;
    return ALP_OK;
}

void alpi_graph_destroy(alpi_graph *graph)
{
    alpi_release(graph->context, graph->nodes);
    *graph = (alpi_graph){0};
}

// --- links ---------------------------------------------------------------------------------------

/// −1, 0 or 1 along an axis: where a child lies in its parent.
static int child_step(bool flat, uint32_t place, int axis)
{
    const uint32_t number = flat ? place % 3 + 3 + place / 3 * 9 : place; // in a volume
    const uint32_t steps[3] = {number % 3, number / 3 % 3, number / 9};
    return (int)steps[axis] - 1;
}

static uint32_t place_of(bool flat, const int step[3])
{
    const uint32_t x = (uint32_t)(step[0] + 1), y = (uint32_t)(step[1] + 1);
    const uint32_t z = (uint32_t)(step[2] + 1);
    return flat ? x + 3 * z : x + 3 * y + 9 * z;
}

static void link_pair(alpi_graph *g, uint32_t node, uint32_t direction, uint32_t other)
{
    g->nodes[node].neighbour[direction] = other;
    g->nodes[other].neighbour[direction ^ 1u] = node;
}

static void unlink_node(alpi_graph *g, uint32_t node)
{
    for (uint32_t d = 0; d < ALPI_GRAPH_DIRECTIONS; d++) {
        const uint32_t other = g->nodes[node].neighbour[d];
        if (other != ALPI_NO_NODE) {
            g->nodes[other].neighbour[d ^ 1u] = ALPI_NO_NODE;
            g->nodes[node].neighbour[d] = ALPI_NO_NODE;
        }
    }
}

/// The neighbour of a child of `parent`: a sibling, or a child of the parent's neighbour.
static uint32_t find_neighbour(const alpi_graph *g, uint32_t parent, uint32_t place, uint32_t d)
{
    const int axis = (int)d / 2, way = d % 2 == 0 ? -1 : 1;
    int step[3];
    for (int k = 0; k < 3; k++) {
        step[k] = child_step(g->flat, place, k);
    }
    uint32_t home = parent;
    step[axis] += way;
    if (step[axis] < -1 || step[axis] > 1) {
        home = g->nodes[parent].neighbour[d];
        step[axis] = -way;
    }
    if (home == ALPI_NO_NODE || g->nodes[home].child == ALPI_NO_NODE) {
        return ALPI_NO_NODE;
    }
    return g->nodes[home].child + place_of(g->flat, step);
}

static void link_child(alpi_graph *g, uint32_t parent, uint32_t place)
{
    for (uint32_t d = 0; d < ALPI_GRAPH_DIRECTIONS; d++) {
        if (g->flat && d / 2 == 1) {
            continue;
        }
        const uint32_t other = find_neighbour(g, parent, place, d);
        if (other != ALPI_NO_NODE) {
            link_pair(g, g->nodes[parent].child + place, d, other);
        }
    }
}

/// Makes the children of a node. @return false, with ALP_OK in *result: at the limit
static bool expand(alpi_graph *g, uint32_t parent, alp_result *result)
{
    const uint32_t count = alpi_graph_child_count(g->flat);
    uint32_t block;
    *result = take_block(g, &block);
    if (*result != ALP_OK || block == ALPI_NO_NODE) {
        return false;
    }
    alpi_graph_node *p = &g->nodes[parent];
    p->child = block;
    p->used = 0;
    for (uint32_t i = 0; i < count; i++) {
        alpi_graph_node *child = &g->nodes[block + i];
        child->parent = parent;
        child->level = (uint8_t)(p->level - 1);
        child->place = (uint8_t)i;
        for (int k = 0; k < 3; k++) {
            child->index[k] = g->flat && k == 1 ? 0 : 3 * p->index[k] + child_step(g->flat, i, k);
        }
    }
    g->nodes[block + alpi_graph_middle(g->flat)].anchor = p->anchor;
    for (uint32_t i = 0; i < count; i++) {
        link_child(g, parent, i);
    }
    return true;
}

/// Copies a node to another number, and mends the links to it.
static void move_node(alpi_graph *g, uint32_t from, uint32_t to)
{
    const alpi_graph_node node = g->nodes[from];
    g->nodes[to].child = node.child;
    g->nodes[to].anchor = node.anchor;
    g->nodes[to].used = node.used;
    if (node.child != ALPI_NO_NODE) {
        for (uint32_t i = 0; i < alpi_graph_child_count(g->flat); i++) {
            g->nodes[node.child + i].parent = to;
        }
    }
}

// --- search --------------------------------------------------------------------------------------

/// Index of the ancestor at a level.
static void ancestor_index(const int32_t index[3], uint32_t level, uint32_t at, int32_t out[3])
{
    memcpy(out, index, 3 * sizeof *out);
    for (uint32_t l = level; l < at; l++) {
        for (int k = 0; k < 3; k++) {
            out[k] = alpi_graph_parent_index(out[k]);
        }
    }
}

bool alpi_graph_reaches(const alpi_graph *g, uint32_t level, const int32_t index[3])
{
    const alpi_graph_node *root = &g->nodes[ALPI_GRAPH_ROOT];
    int32_t top[3];
    if (level > root->level) {
        return false;
    }
    ancestor_index(index, level, root->level, top);
    return memcmp(top, root->index, sizeof top) == 0;
}

static uint32_t child_towards(const alpi_graph *g, uint32_t node, uint32_t level,
                              const int32_t index[3])
{
    const alpi_graph_node *n = &g->nodes[node];
    int32_t below[3];
    int step[3];
    ancestor_index(index, level, (uint32_t)n->level - 1, below);
    for (int k = 0; k < 3; k++) {
        step[k] = below[k] - 3 * n->index[k];
    }
    return place_of(g->flat, step);
}

uint32_t alpi_graph_find(const alpi_graph *g, uint32_t level, const int32_t index[3])
{
    if (!alpi_graph_reaches(g, level, index)) {
        return ALPI_NO_NODE;
    }
    uint32_t node = ALPI_GRAPH_ROOT;
    while (g->nodes[node].level > level) {
        if (g->nodes[node].child == ALPI_NO_NODE) {
            return ALPI_NO_NODE;
        }
        node = g->nodes[node].child + child_towards(g, node, level, index);
    }
    return node;
}

/// Sets bits of `used` from a node upwards.
static void mark_used(alpi_graph *g, uint32_t node)
{
    while (g->nodes[node].parent != ALPI_NO_NODE) {
        alpi_graph_node *parent = &g->nodes[g->nodes[node].parent];
        const uint32_t bit = 1u << g->nodes[node].place;
        if ((parent->used & bit) != 0) {
            return;
        }
        parent->used |= bit;
        node = g->nodes[node].parent;
    }
}

/// Whether a child keeps its siblings in the graph.
static bool is_used(const alpi_graph *g, uint32_t node)
{
    const alpi_graph_node *n = &g->nodes[node];
    const bool shared = n->place == alpi_graph_middle(g->flat) && n->level < g->depth;
    return (n->anchor != ALPI_NO_ANCHOR && !shared) || n->used != 0;
}

// --- growth --------------------------------------------------------------------------------------

/// The root becomes a child of a new root. @return false: at a limit
static bool grow_root(alpi_graph *g, alp_result *result)
{
    const alpi_graph_node old = g->nodes[ALPI_GRAPH_ROOT];
    *result = ALP_OK;
    if (old.level + 1 >= ALPI_GRAPH_LEVELS) {
        return false;
    }
    alpi_graph_node *root = &g->nodes[ALPI_GRAPH_ROOT];
    clear_node(root);
    root->level = (uint8_t)(old.level + 1);
    int step[3];
    for (int k = 0; k < 3; k++) {
        root->index[k] = alpi_graph_parent_index(old.index[k]);
        step[k] = old.index[k] - 3 * root->index[k];
    }
    if (!expand(g, ALPI_GRAPH_ROOT, result)) {
        g->nodes[ALPI_GRAPH_ROOT] = old;
        return false;
    }
    const uint32_t node = g->nodes[ALPI_GRAPH_ROOT].child + place_of(g->flat, step);
    alpi_graph_node *child = &g->nodes[node];
    child->child = old.child;
    child->anchor = old.anchor;
    child->used = old.used;
    if (old.child != ALPI_NO_NODE) {
        for (uint32_t i = 0; i < alpi_graph_child_count(g->flat); i++) {
            g->nodes[old.child + i].parent = node;
        }
    }
    if (is_used(g, node)) {
        mark_used(g, node);
    }
    return true;
}

alp_result alpi_graph_require(alpi_graph *g, uint32_t level, const int32_t index[3], uint32_t *out)
{
    alp_result result = ALP_OK;
    *out = ALPI_NO_NODE;
    while (!alpi_graph_reaches(g, level, index)) {
        if (!grow_root(g, &result)) {
            return result;
        }
    }
    uint32_t node = ALPI_GRAPH_ROOT;
    while (g->nodes[node].level > level) {
        if (g->nodes[node].child == ALPI_NO_NODE && !expand(g, node, &result)) {
            return result;
        }
        node = g->nodes[node].child + child_towards(g, node, level, index);
    }
    *out = node;
    return ALP_OK;
}

// --- anchors -------------------------------------------------------------------------------------

uint32_t alpi_graph_top(const alpi_graph *g, uint32_t node)
{
    while (g->nodes[node].level < g->depth && g->nodes[node].place == alpi_graph_middle(g->flat)) {
        node = g->nodes[node].parent;
    }
    return node;
}

/// Clears bits of `used` upwards, as far as nothing else keeps them.
static void unmark_used(alpi_graph *g, uint32_t node)
{
    while (g->nodes[node].parent != ALPI_NO_NODE && !is_used(g, node)) {
        g->nodes[g->nodes[node].parent].used &= ~(1u << g->nodes[node].place);
        node = g->nodes[node].parent;
    }
}

void alpi_graph_set_anchor(alpi_graph *g, uint32_t node, uint32_t anchor)
{
    const uint32_t top = alpi_graph_top(g, node);
    uint32_t n = top;
    while (n != ALPI_NO_NODE) {
        g->nodes[n].anchor = anchor;
        n = g->nodes[n].child == ALPI_NO_NODE ? ALPI_NO_NODE
                                              : g->nodes[n].child + alpi_graph_middle(g->flat);
    }
    if (is_used(g, top)) {
        mark_used(g, top);
    } else {
        unmark_used(g, top);
    }
}

// --- pruning -------------------------------------------------------------------------------------

static void remove_children(alpi_graph *g, uint32_t node)
{
    const uint32_t block = g->nodes[node].child;
    for (uint32_t i = 0; i < alpi_graph_child_count(g->flat); i++) {
        unlink_node(g, block + i);
    }
    give_block(g, block);
    g->nodes[node].child = ALPI_NO_NODE;
    g->nodes[node].used = 0;
}

static void prune_below(alpi_graph *g, uint32_t node)
{
    const uint32_t block = g->nodes[node].child;
    if (block == ALPI_NO_NODE) {
        return;
    }
    for (uint32_t i = 0; i < alpi_graph_child_count(g->flat); i++) {
        prune_below(g, block + i);
    }
    if (g->nodes[node].used == 0) {
        remove_children(g, node);
    }
}

/// The only used child of the root, or the middle one where none is; NO_NODE: several.
static uint32_t only_child(const alpi_graph *g)
{
    const alpi_graph_node *root = &g->nodes[ALPI_GRAPH_ROOT];
    const uint32_t used = root->used;
    if ((used & (used - 1)) != 0) {
        return ALPI_NO_NODE;
    }
    return root->child + (used != 0 ? (uint32_t)__builtin_ctz(used) : alpi_graph_middle(g->flat));
}

static void shrink_root(alpi_graph *g)
{
    alpi_graph_node *root = &g->nodes[ALPI_GRAPH_ROOT];
    while (root->level > g->depth) {
        if (root->child == ALPI_NO_NODE) { // nothing below: the middle
            for (int k = 0; k < 3; k++) {
                root->index[k] *= 3;
            }
            root->level--;
            continue;
        }
        const uint32_t block = root->child, child = only_child(g);
        if (child == ALPI_NO_NODE) {
            return;
        }
        for (uint32_t i = 0; i < alpi_graph_child_count(g->flat); i++) {
            unlink_node(g, block + i);
        }
        memcpy(root->index, g->nodes[child].index, sizeof root->index);
        root->level--;
        move_node(g, child, ALPI_GRAPH_ROOT);
        give_block(g, block);
    }
}

void alpi_graph_prune(alpi_graph *g)
{
    prune_below(g, ALPI_GRAPH_ROOT);
    shrink_root(g);
}

// --- memory --------------------------------------------------------------------------------------

static bool is_free(const alpi_graph *g, uint32_t block)
{
    return g->nodes[block].parent == ALPI_NO_NODE; // the root is in no block
}

/// Moves the children of a node to a free block.
static void move_block(alpi_graph *g, uint32_t from, uint32_t to)
{
    const uint32_t count = alpi_graph_child_count(g->flat), parent = g->nodes[from].parent;
    for (uint32_t i = 0; i < count; i++) {
        clear_node(&g->nodes[to + i]);
        move_node(g, from + i, to + i);
        unlink_node(g, from + i);
    }
    g->nodes[parent].child = to;
    for (uint32_t i = 0; i < count; i++) {
        const alpi_graph_node *old = &g->nodes[from + i];
        alpi_graph_node *node = &g->nodes[to + i];
        memcpy(node->index, old->index, sizeof node->index);
        node->parent = parent;
        node->level = old->level;
        node->place = old->place;
    }
    for (uint32_t i = 0; i < count; i++) {
        link_child(g, parent, i);
    }
}

alp_result alpi_graph_compact(alpi_graph *g)
{
    const uint32_t count = alpi_graph_child_count(g->flat);
    uint32_t hole = 1;
    while (g->node_end > g->node_count) {
        const uint32_t last = g->node_end - count;
        if (!is_free(g, last)) {
            while (!is_free(g, hole)) {
                hole += count;
            }
            move_block(g, last, hole);
        }
        g->node_end = last;
    }
    g->free_block = ALPI_NO_NODE;
    return alpi_fit(g->context, (void **)&g->nodes, &g->node_capacity, g->node_end,
                    sizeof *g->nodes);
}
