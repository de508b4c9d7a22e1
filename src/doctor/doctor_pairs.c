// SPDX-License-Identifier: MIT
// Pairs of triangles by a tree of boxes over their places and normals, held against itself:
// surfaces that are curved meet hardly any other box.
//
// Based on: C. Lauterbach, M. Garland, S. Sengupta, D. Luebke, D. Manocha. Fast BVH Construction on
// GPUs. Eurographics 2009 (triangles sorted along a Z-curve; here the tree is complete, and each
// node's place in its array says which leaves are below it).
#include "doctor/doctor_pairs.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>

enum {
    LEAF = 4,        // triangles
    KEY_BITS = 21,   // of a coordinate
    DIGIT_BITS = 11, // of a key, for sorting
    DIGIT_COUNT = 6, // 63 bits
    STEPS_PER_TICK = 1 << 16,
    STACK = 128 // four for one at each of 30 levels
};
static const double LEAST_HEIGHT = 64.0; // roundings: normals are right to 1/16

/// Places and normals, both with room for rounding.
typedef struct box {
    float low[6], high[6];
} box;

typedef struct item {
    box box;
    uint32_t triangle;
} item;

typedef struct order {
    uint64_t key;
    uint32_t triangle;
} order;

typedef struct tree {
    alp_context *context;
    const alp_scene *scene;
    order *orders; // [count]
    item *items;   // [count] along the curve
    box *nodes;    // [2 · leaves]: 1 is the root, n has 2n and 2n + 1
    uint32_t count, leaves;
} tree;

// --- along the curve -----------------------------------------------------------------------------

/// Spreads 21 bits, with two free ones behind each.
static uint64_t spread_bits(uint64_t bits)
{
    bits = (bits | bits << 32) & 0x001F00000000FFFFu;
    bits = (bits | bits << 16) & 0x001F0000FF0000FFu;
    bits = (bits | bits << 8) & 0x100F00F00F00F00Fu;
    bits = (bits | bits << 4) & 0x10C30C30C30C30C3u;
    return (bits | bits << 2) & 0x1249249249249249u;
}

static uint64_t key_of(const alp_scene *scene, vec3 middle, double scale)
{
    const vec3 from = scene->bounds_min;
    const double at[3] = {(double)middle.x - (double)from.x, (double)middle.y - (double)from.y,
                          (double)middle.z - (double)from.z};
    uint64_t key = 0;
    for (int k = 0; k < 3; k++) {
        const double cells = (double)((1 << KEY_BITS) - 1);
        key |= spread_bits((uint64_t)fmin(fmax(at[k] * scale, 0.0), cells)) << k;
    }
    return key;
}

static float longest_edge(const vec3 c[3])
{
    float longest = 0.0f;
    for (int k = 0; k < 3; k++) {
        const vec3 edge = vec3_sub(c[(k + 1) % 3], c[k]);
        const float square = vec3_dot(edge, edge);
        longest = square > longest ? square : longest;
    }
    return sqrtf(longest);
}

/// Whether a triangle's normal is known.
static bool has_plane(const vec3 c[3])
{
    const double area = vec3_triangle_area(c[0], c[1], c[2]);
    return 2.0 * area > LEAST_HEIGHT * alpi_doctor_rounding(c) * (double)longest_edge(c);
}

static void collect(tree *t)
{
    const alp_scene *scene = t->scene;
    const vec3 size = vec3_sub(scene->bounds_max, scene->bounds_min);
    const double side = (double)fmaxf(size.x, fmaxf(size.y, size.z));
    const double scale = side > 0.0 ? (double)(1 << KEY_BITS) / side : 0.0;
    for (uint32_t i = 0; i < scene->triangle_count; i++) {
        vec3 c[3];
        if (!scene->triangle_usable[i]) {
            continue;
        }
        alpi_triangle_corners(scene, i, c);
        if (has_plane(c)) {
            const vec3 low = vec3_min(c[0], vec3_min(c[1], c[2]));
            const vec3 high = vec3_max(c[0], vec3_max(c[1], c[2]));
            const vec3 middle = vec3_add(vec3_scale(low, 0.5f), vec3_scale(high, 0.5f));
            t->orders[t->count++] = (order){key_of(scene, middle, scale), i};
        }
    }
}

/// Sorts by keys, digit by digit; equal ones stay in their order.
static alp_result sort_orders(tree *t)
{
    enum { DIGITS = 1 << DIGIT_BITS };
    order *spare = ALPI_NEW(t->context, order, t->count);
    if (spare == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (int digit = 0; digit < DIGIT_COUNT; digit++) { // an even number: the end is where it began
        const int shift = digit * DIGIT_BITS;
        uint32_t first[DIGITS] = {0}, sum = 0;
        for (uint32_t i = 0; i < t->count; i++) {
            first[t->orders[i].key >> shift & (DIGITS - 1)]++;
        }
        for (int d = 0; d < DIGITS; d++) {
            const uint32_t here = first[d];
            first[d] = sum;
            sum += here;
        }
        for (uint32_t i = 0; i < t->count; i++) {
            spare[first[t->orders[i].key >> shift & (DIGITS - 1)]++] = t->orders[i];
        }
        order *swap = t->orders;
        t->orders = spare;
        spare = swap;
    }
    alpi_release(t->context, spare);
    return ALP_OK;
}

// --- boxes ---------------------------------------------------------------------------------------

static item make_item(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    const double rounding = alpi_doctor_rounding(c), area = vec3_triangle_area(c[0], c[1], c[2]);
    const vec3 n = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    const vec3 low = vec3_min(c[0], vec3_min(c[1], c[2]));
    const vec3 high = vec3_max(c[0], vec3_max(c[1], c[2]));
    // Half the most that two planes may lean to each other: a rounding at each end of the height.
    const float lean = (float)(2.0 * rounding * (double)longest_edge(c) / (2.0 * area) + 1e-6);
    const float pad = (float)rounding;
    return (item){{{low.x - pad, low.y - pad, low.z - pad, n.x - lean, n.y - lean, n.z - lean},
                   {high.x + pad, high.y + pad, high.z + pad, n.x + lean, n.y + lean, n.z + lean}},
                  triangle};
}

static box join(const box *a, const box *b)
{
    box both;
    for (int k = 0; k < 6; k++) {
        both.low[k] = a->low[k] < b->low[k] ? a->low[k] : b->low[k];
        both.high[k] = a->high[k] > b->high[k] ? a->high[k] : b->high[k];
    }
    return both;
}

/// Places first, which tell most apart, then normals; axis by axis without a branch.
static bool overlap(const box *a, const box *b)
{
    bool apart[3];
    for (int k = 0; k < 3; k++) {
        apart[k] = (a->low[k] > b->high[k]) | (b->low[k] > a->high[k]);
    }
    if (apart[0] | apart[1] | apart[2]) {
        return false;
    }
    for (int k = 0; k < 3; k++) {
        apart[k] = (a->low[k + 3] > b->high[k + 3]) | (b->low[k + 3] > a->high[k + 3]);
    }
    return !(apart[0] | apart[1] | apart[2]);
}

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static alp_result build(tree *t)
{
    ALPI_TRY_NEW(t->context, t->items, t->count);
    for (uint32_t i = 0; i < t->count; i++) {
        t->items[i] = make_item(t->scene, t->orders[i].triangle);
    }
    t->leaves = 1;
    while ((uint64_t)t->leaves * LEAF < t->count) {
        t->leaves *= 2;
    }
    ALPI_TRY_NEW(t->context, t->nodes, 2 * (size_t)t->leaves);
    const float far = (float)INFINITY;
    const box none = {{far, far, far, far, far, far}, {-far, -far, -far, -far, -far, -far}};
    for (uint32_t leaf = 0; leaf < t->leaves; leaf++) {
        box *node = &t->nodes[t->leaves + leaf];
        *node = none;
        const uint64_t first = (uint64_t)leaf * LEAF;
        for (uint64_t i = first; i < first + LEAF && i < t->count; i++) {
            *node = join(node, &t->items[i].box);
        }
    }
    for (uint32_t n = t->leaves - 1; n > 0; n--) {
        t->nodes[n] = join(&t->nodes[2 * (size_t)n], &t->nodes[2 * (size_t)n + 1]);
    }
    return ALP_OK;
}

// --- pairs ---------------------------------------------------------------------------------------

typedef struct visit {
    const tree *tree;
    uint64_t looks_left, pairs_left;
    alpi_doctor_pair_fn *each;
    void *user;
} visit;

/// Visits the pairs of two leaves, or of one with itself.
static alp_result visit_leaves(visit *v, uint32_t own, uint32_t other)
{
    const tree *t = v->tree;
    const uint32_t end = least((own + 1) * LEAF, t->count);
    const uint32_t other_end = least((other + 1) * LEAF, t->count);
    for (uint32_t i = own * LEAF; i < end; i++) {
        if (!overlap(&t->items[i].box, &t->nodes[t->leaves + other])) {
            continue;
        }
        for (uint32_t j = own == other ? i + 1 : other * LEAF; j < other_end; j++) {
            v->looks_left -= v->looks_left > 0;
            if (overlap(&t->items[i].box, &t->items[j].box)) {
                v->pairs_left -= v->pairs_left > 0;
                const uint32_t a = t->items[i].triangle, b = t->items[j].triangle;
                ALP_TRY(v->each(v->user, a < b ? a : b, a < b ? b : a));
            }
        }
    }
    return ALP_OK;
}

/// Two nodes of one level, or one twice, to be looked at.
typedef struct meeting {
    uint32_t a, b;
} meeting;

/// Puts the children of two nodes that overlap, or of one, on the stack. @return its new height
static uint32_t part(const tree *t, meeting m, meeting *stack, uint32_t height)
{
    for (uint32_t i = 0; i < 4; i++) {
        const meeting child = {2 * m.a + i / 2, 2 * m.b + i % 2};
        const bool again = m.a == m.b && child.a > child.b;
        if (!again && overlap(&t->nodes[child.a], &t->nodes[child.b])) {
            stack[height++] = child;
        }
    }
    return height;
}

/// Goes down from the root, both nodes of a pair at a time.
static alp_result visit_all(const tree *t, alpi_doctor_pair_fn *each, void *user, bool *all)
{
    visit v = {t, ALPI_DOCTOR_PAIRS_LEAST + (uint64_t)ALPI_DOCTOR_LOOKS_EACH * t->count,
               ALPI_DOCTOR_PAIRS_LEAST + (uint64_t)ALPI_DOCTOR_PAIRS_EACH * t->count, each, user};
    meeting stack[STACK] = {{1, 1}};
    uint32_t height = 1, steps = 0;
    while (height > 0 && v.looks_left > 0 && v.pairs_left > 0) {
        const meeting m = stack[--height];
        if (++steps % STEPS_PER_TICK == 0) {
            ALP_TRY(alpi_tick(t->context, "diagnose", 0, t->count));
        }
        if (m.a >= t->leaves) {
            ALP_TRY(visit_leaves(&v, m.a - t->leaves, m.b - t->leaves));
        } else {
            height = part(t, m, stack, height);
        }
    }
    *all = height == 0;
    return ALP_OK;
}

alp_result alpi_doctor_visit_pairs(const alp_scene *scene, alpi_doctor_pair_fn *each, void *user,
                                   bool *all)
{
    tree t = {.context = scene->context, .scene = scene};
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    *all = true;
    t.orders = ALPI_NEW(t.context, order, scene->usable_count);
    if (t.orders != NULL) {
        collect(&t);
        result = t.count > 0 ? sort_orders(&t) : ALP_OK;
    }
    if (result == ALP_OK && t.count > 0) {
        result = build(&t);
        result = result == ALP_OK ? visit_all(&t, each, user, all) : result;
    }
    alpi_release(t.context, t.orders);
    alpi_release(t.context, t.items);
    alpi_release(t.context, t.nodes);
    return result;
}
