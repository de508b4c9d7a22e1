// SPDX-License-Identifier: MIT
// The graph against a slow twin: a list of places with anchors, from which all nodes follow.
#include "test_support.h"

#include "fields/ambience/ambience_graph.h"

#include <stdlib.h>

TEST_CONTEXT(1);

enum { DEPTH = 3, PLACES = 40 };

/// A place that has an anchor: its topmost node up to level DEPTH.
typedef struct twin_place {
    uint32_t level;
    int32_t index[3];
} twin_place;

typedef struct twin {
    twin_place places[PLACES];
    uint32_t count;
} twin;

static uint32_t draw(uint64_t *state, uint32_t count)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 33) % count;
}

static void go_up(twin_place *p)
{
    for (int k = 0; k < 3; k++) { // round(i / 3)
        p->index[k] = (int32_t)((p->index[k] + 3000001) / 3 - 1000000);
    }
    p->level++;
}

static bool is_same(const twin_place *a, const twin_place *b)
{
    return a->level == b->level && memcmp(a->index, b->index, sizeof a->index) == 0;
}

/// The ancestor at a level, from that level downwards the node itself.
static twin_place ancestor(twin_place p, uint32_t level)
{
    while (p.level < level) {
        go_up(&p);
    }
    return p;
}

static twin_place top_of(twin_place p)
{
    while (p.level < DEPTH && p.index[0] % 3 == 0 && p.index[1] % 3 == 0 && p.index[2] % 3 == 0) {
        for (int k = 0; k < 3; k++) {
            p.index[k] /= 3;
        }
        p.level++;
    }
    return p;
}

/// Whether a node is above a place that has an anchor: then it has children.
static bool is_parent(const twin *t, twin_place node)
{
    for (uint32_t i = 0; i < t->count; i++) {
        const twin_place *p = &t->places[i];
        const twin_place up = ancestor(*p, node.level);
        if (p->level < node.level && is_same(&up, &node)) {
            return true;
        }
    }
    return false;
}

static bool has_node(const twin *t, const alpi_graph_node *root, twin_place node)
{
    const twin_place top = {root->level, {root->index[0], root->index[1], root->index[2]}};
    const twin_place at_root = ancestor(node, root->level);
    if (node.level > root->level || !is_same(&at_root, &top)) {
        return false;
    }
    while (!is_same(&node, &top)) {
        go_up(&node);
        if (!is_parent(t, node)) {
            return false;
        }
    }
    return true;
}

static int find_place(const twin *t, twin_place p)
{
    const twin_place top = top_of(p);
    for (uint32_t i = 0; i < t->count; i++) {
        if (is_same(&t->places[i], &top)) {
            return (int)i;
        }
    }
    return -1;
}

/// The least root that is above all places.
static uint32_t least_root(const twin *t)
{
    uint32_t level = DEPTH;
    for (bool same = false; !same;) {
        same = true;
        const twin_place first = t->count > 0 ? ancestor(t->places[0], level) : (twin_place){0};
        for (uint32_t i = 1; i < t->count; i++) {
            const twin_place other = ancestor(t->places[i], level);
            same = same && is_same(&first, &other);
        }
        level += !same;
    }
    return level;
}

static void check_node(const alpi_graph *g, const twin *t, uint32_t number)
{
    const alpi_graph_node *n = &g->nodes[number], *root = &g->nodes[ALPI_GRAPH_ROOT];
    const twin_place here = {n->level, {n->index[0], n->index[1], n->index[2]}};
    assert_int_equal(alpi_graph_find(g, n->level, n->index), number);
    assert_int_equal(n->child != ALPI_NO_NODE, is_parent(t, here));
    const int place = n->level <= DEPTH ? find_place(t, here) : -1;
    assert_int_equal(n->anchor, place < 0 ? ALPI_NO_ANCHOR : (uint32_t)place + 100);
    for (uint32_t d = 0; d < ALPI_GRAPH_DIRECTIONS; d++) {
        twin_place there = here;
        there.index[d / 2] += d % 2 == 0 ? -1 : 1;
        const bool flat_axis = g->flat && d / 2 == 1;
        const uint32_t other = n->neighbour[d];
        assert_int_equal(other != ALPI_NO_NODE, !flat_axis && has_node(t, root, there));
        if (other != ALPI_NO_NODE) {
            assert_int_equal(other, alpi_graph_find(g, here.level, there.index));
            assert_int_equal(g->nodes[other].neighbour[d ^ 1u], number);
        }
    }
}

static uint32_t check_below(const alpi_graph *g, const twin *t, uint32_t number)
{
    uint32_t count = 1;
    check_node(g, t, number);
    for (uint32_t i = 0;
         g->nodes[number].child != ALPI_NO_NODE && i < alpi_graph_child_count(g->flat); i++) {
        const uint32_t child = g->nodes[number].child + i;
        assert_int_equal(g->nodes[child].parent, number);
        assert_int_equal(g->nodes[child].place, i);
        count += check_below(g, t, child);
    }
    return count;
}

static void fuzz(bool flat, uint64_t seed, int steps)
{
    alpi_graph g;
    twin t = {.count = 0};
    ASSERT_OK(context, alpi_graph_create(context, flat, DEPTH, 1u << 16, &g));
    for (int step = 0; step < steps; step++) {
        // Mostly near the origin, at times far outside of the root.
        const uint32_t level = draw(&seed, DEPTH + 1), kind = draw(&seed, 20);
        const uint32_t wide = kind == 0 ? 100000 : kind < 4 ? 200 : 40;
        twin_place p = {level, {0, 0, 0}};
        for (int k = 0; k < 3; k++) {
            p.index[k] = flat && k == 1 ? 0 : (int32_t)draw(&seed, wide) - (int32_t)(wide / 2);
        }
        const int had = find_place(&t, p);
        const bool take = draw(&seed, 2) == 0 || t.count >= PLACES - 1;
        if (take && t.count > 0) { // any other
            const uint32_t gone = draw(&seed, t.count);
            const uint32_t node = alpi_graph_find(&g, t.places[gone].level, t.places[gone].index);
            assert_int_not_equal(node, ALPI_NO_NODE);
            alpi_graph_set_anchor(&g, node, ALPI_NO_ANCHOR);
            const uint32_t last = --t.count;
            if (gone != last) {
                t.places[gone] = t.places[last];
                alpi_graph_set_anchor(
                    &g, alpi_graph_find(&g, t.places[gone].level, t.places[gone].index),
                    gone + 100);
            }
        } else if (had < 0) {
            uint32_t node;
            ASSERT_OK(context, alpi_graph_require(&g, p.level, p.index, &node));
            assert_int_not_equal(node, ALPI_NO_NODE);
            alpi_graph_set_anchor(&g, node, 100 + t.count);
            t.places[t.count++] = top_of(p);
        }
        alpi_graph_prune(&g);
        if (step % 3 == 0) {
            ASSERT_OK(context, alpi_graph_compact(&g));
            assert_int_equal(g.node_end, g.node_count);
        }
        if (step % 7 == 0) {
            const uint32_t count = check_below(&g, &t, ALPI_GRAPH_ROOT);
            assert_int_equal(count, g.node_count);
            if (t.count > 0) {
                assert_int_equal(g.nodes[ALPI_GRAPH_ROOT].level, least_root(&t));
            }
        }
    }
    while (t.count > 0) {
        t.count--;
        alpi_graph_set_anchor(&g,
                              alpi_graph_find(&g, t.places[t.count].level, t.places[t.count].index),
                              ALPI_NO_ANCHOR);
    }
    alpi_graph_prune(&g);
    assert_int_equal(g.node_count, 1); // the pool is back at its start
    assert_int_equal(g.nodes[ALPI_GRAPH_ROOT].level, DEPTH);
    alpi_graph_destroy(&g);
}

TEST(the_graph_is_its_twin)
{
    for (uint64_t seed = 1; seed <= 8; seed++) {
        fuzz(false, seed, test_is_quick() ? 60 : 200);
    }
}

TEST(a_flat_graph_is_its_twin)
{
    for (uint64_t seed = 1; seed <= 8; seed++) {
        fuzz(true, seed, test_is_quick() ? 60 : 200);
    }
}

TEST(all_children_are_made_at_once)
{
    alpi_graph g;
    uint32_t node;
    const int32_t corner[3] = {-1, -1, -1};
    ASSERT_OK(context, alpi_graph_create(context, false, 2, 1000, &g));
    alpi_graph_set_anchor(&g, ALPI_GRAPH_ROOT, 7);
    ASSERT_OK(context, alpi_graph_require(&g, 1, corner, &node));
    assert_int_equal(g.node_count, 28);
    assert_int_equal(node, g.nodes[ALPI_GRAPH_ROOT].child);
    assert_int_equal(g.nodes[g.nodes[ALPI_GRAPH_ROOT].child + 13].anchor, 7); // the middle
    alpi_graph_prune(&g); // an anchor that is the root's does not keep them
    assert_int_equal(g.node_count, 1);
    alpi_graph_destroy(&g);
}

TEST(nodes_end_at_the_limit)
{
    alpi_graph g;
    uint32_t node;
    const int32_t far[3] = {1 << 28, 0, 0}, near[3] = {1, 1, 1};
    ASSERT_OK(context, alpi_graph_create(context, false, 4, 60, &g));
    ASSERT_OK(context, alpi_graph_require(&g, 0, near, &node));
    assert_int_equal(node, ALPI_NO_NODE);
    assert_in_range(g.node_count, 1, 60);
    ASSERT_OK(context, alpi_graph_require(&g, 0, far, &node));
    assert_int_equal(node, ALPI_NO_NODE);
    assert_in_range(g.node_count, 1, 60);
    alpi_graph_prune(&g);
    assert_int_equal(g.node_count, 1);
    alpi_graph_destroy(&g);
}
