// SPDX-License-Identifier: MIT
// A binary hierarchy of lights, and draws from it.
// Based on: Alejandro Conty Estevez, Christopher Kulla. Importance Sampling of Many Lights with
// Adaptive Tree Splitting. PACMCGIT 1(2), HPG 2018: its measure of orientation for building, its
// importance for drawing. One light is drawn; nodes are not split by the receiver.
#include "scene/lights/light_tree.h"

#include "base/memory.h"
#include "scene/double3.h"

#include <stdlib.h>

typedef struct tree_node {
    vec3 center;
    float radius; // of the sphere around its box, metres
    vec3 axis;
    float cos_cone, sin_cone, cos_reach;
    bool two_sided;
    double power;
    uint32_t parent; // of the root: itself
    uint32_t child;  // first of two neighbours; 0 = a leaf
    uint32_t light;  // of a leaf
} tree_node;

struct alpi_light_tree {
    tree_node *nodes; // [2 count − 1], parents before their children
    uint32_t *leaf;   // [count]: the node of each light
};

// --- bounds --------------------------------------------------------------------------------------

static const alpi_light_bound EMPTY = {.low = {INFINITY, INFINITY, INFINITY},
                                       .high = {-INFINITY, -INFINITY, -INFINITY}};

/// The smallest cone around two, if neither holds the other.
static void join_cones(const alpi_light_bound *a, const alpi_light_bound *b,
                       alpi_light_bound *joined)
{
    const float straight = (float)ALPI_PI;
    if (b->cone > a->cone) {
        const alpi_light_bound *c = a;
        a = b;
        b = c;
    }
    vec3 other = b->axis;
    if (joined->two_sided && vec3_dot(a->axis, other) < 0.0f) {
        other = vec3_scale(other, -1.0f);
    }
    float between = acosf(fminf(fmaxf(vec3_dot(a->axis, other), -1.0f), 1.0f));
    joined->axis = a->axis;
    joined->cone = a->cone;
    if (fminf(between + b->cone, straight) <= a->cone) {
        return;
    }
    joined->cone = 0.5f * (a->cone + between + b->cone);
    vec3 away = vec3_normalize_or(vec3_mad(other, -vec3_dot(a->axis, other), a->axis),
                                  (vec3){0.0f, 0.0f, 0.0f});
    if (joined->cone >= straight || vec3_length(away) < 0.5f) {
        joined->cone = straight;
        return;
    }
    float turn = joined->cone - a->cone;
    joined->axis =
        vec3_normalize_or(vec3_mad(vec3_scale(a->axis, cosf(turn)), sinf(turn), away), a->axis);
    joined->cone += 1e-6f; // what rounding took
}

static alpi_light_bound join(const alpi_light_bound *a, const alpi_light_bound *b)
{
    if (!(a->power > 0.0)) {
        return *b;
    }
    if (!(b->power > 0.0)) {
        return *a;
    }
    alpi_light_bound joined = {.low = vec3_min(a->low, b->low),
                               .high = vec3_max(a->high, b->high),
                               .reach = fmaxf(a->reach, b->reach),
                               .two_sided = a->two_sided || b->two_sided,
                               .power = a->power + b->power};
    join_cones(a, b, &joined);
    return joined;
}

static float component(vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static double squared_diagonal(const alpi_light_bound *b)
{
    double3 size = double3_between(b->low, b->high);
    return double3_dot(size, size);
}

/// Cost of a node (section 4.4 of the paper): power × size × the solid angle it shines into. Lamps
/// are flat and often in a row, so size is the diagonal's square, not the area of the box.
static double cost(const alpi_light_bound *b)
{
    if (!(b->power > 0.0)) {
        return 0.0;
    }
    double cone = (double)b->cone, edge = fmin(cone + (double)b->reach, ALPI_PI);
    double angle =
        2.0 * ALPI_PI * (1.0 - cos(cone)) +
        ALPI_PI / 2.0 *
            (2.0 * edge * sin(cone) - cos(cone - 2.0 * edge) - 2.0 * cone * sin(cone) + cos(cone));
    return b->power * squared_diagonal(b) * angle;
}

// --- building ------------------------------------------------------------------------------------

enum {
    BUCKET_COUNT = 12,
    EVEN_DEPTH = 32, // from here on halves: no path is longer than 32 + 32
    STACK_SIZE = 2 * 64
};

/// Lights first … last−1 of the order become node `node`.
typedef struct build_task {
    uint32_t node, first, last, depth;
} build_task;

typedef struct builder {
    const alpi_light_bound *bounds;
    uint32_t *order;
    alpi_light_tree *tree;
    uint32_t node_count;
} builder;

typedef struct split {
    int axis; // −1 = none that separates
    float low, scale;
    int last_left; // bucket
} split;

static float middle(const alpi_light_bound *b, int axis)
{
    return 0.5f * component(b->low, axis) + 0.5f * component(b->high, axis);
}

static int bucket_of(const alpi_light_bound *b, const split *s)
{
    float place = (middle(b, s->axis) - s->low) * s->scale;
    int bucket = (int)place;
    return bucket < BUCKET_COUNT ? bucket : BUCKET_COUNT - 1;
}

/// The cheapest place to part the buckets of one axis; *best is what it costs, before and after.
static void try_axis(const builder *b, const build_task *task, split candidate, double factor,
                     double *best, split *found)
{
    alpi_light_bound buckets[BUCKET_COUNT], right[BUCKET_COUNT];
    for (int i = 0; i < BUCKET_COUNT; i++) {
        buckets[i] = EMPTY;
    }
    for (uint32_t i = task->first; i < task->last; i++) {
        const alpi_light_bound *bound = &b->bounds[b->order[i]];
        int k = bucket_of(bound, &candidate);
        buckets[k] = join(&buckets[k], bound);
    }
    right[BUCKET_COUNT - 1] = buckets[BUCKET_COUNT - 1];
    for (int i = BUCKET_COUNT - 2; i > 0; i--) {
        right[i] = join(&buckets[i], &right[i + 1]);
    }
    alpi_light_bound left = EMPTY;
    for (int i = 0; i + 1 < BUCKET_COUNT; i++) {
        left = join(&left, &buckets[i]);
        double sum = factor * (cost(&left) + cost(&right[i + 1]));
        if (left.power > 0.0 && right[i + 1].power > 0.0 && sum < *best) {
            *best = sum;
            *found = candidate;
            found->last_left = i;
        }
    }
}

static split find_split(const builder *b, const build_task *task, const alpi_light_bound *all)
{
    split found = {.axis = -1};
    double best = HUGE_VAL;
    double3 size = double3_between(all->low, all->high);
    double longest = fmax(fmax(size.x, size.y), size.z);
    for (int axis = 0; axis < 3; axis++) {
        float low = INFINITY, high = -INFINITY;
        for (uint32_t i = task->first; i < task->last; i++) {
            float place = middle(&b->bounds[b->order[i]], axis);
            low = fminf(low, place);
            high = fmaxf(high, place);
        }
        float scale = (float)BUCKET_COUNT / (high - low);
        if (high > low && isfinite(scale)) {
            // Thin boxes are not cut along their thin side (the paper's regularisation).
            double side = (double)component(all->high, axis) - (double)component(all->low, axis);
            split candidate = {.axis = axis, .low = low, .scale = scale};
            try_axis(b, task, candidate, longest / fmax(side, longest * 1e-6), &best, &found);
        }
    }
    return found;
}

/// Puts the left side first, keeping the order within; returns where the right one begins.
static uint32_t part(builder *b, const build_task *task, const split *s, uint32_t *scratch)
{
    uint32_t left = task->first, right = 0;
    for (uint32_t i = task->first; i < task->last; i++) {
        uint32_t light = b->order[i];
        if (bucket_of(&b->bounds[light], s) <= s->last_left) {
            b->order[left++] = light;
        } else {
            scratch[right++] = light;
        }
    }
    for (uint32_t i = 0; i < right; i++) {
        b->order[left + i] = scratch[i];
    }
    return left;
}

static void fill_node(tree_node *node, const alpi_light_bound *all)
{
    node->center = (vec3){middle(all, 0), middle(all, 1), middle(all, 2)};
    // A little more, for what rounding took from the middle and the bounds.
    node->radius = (float)(0.5 * sqrt(squared_diagonal(all)) * (1.0 + 1e-5));
    node->axis = all->axis;
    node->cos_cone = cosf(all->cone);
    node->sin_cone = all->cone >= (float)ALPI_PI ? 0.0f : sinf(all->cone);
    node->cos_reach = cosf(all->reach);
    node->two_sided = all->two_sided;
    node->power = all->power;
}

static void build(builder *b, uint32_t count, uint32_t *scratch)
{
    build_task stack[STACK_SIZE];
    int depth = 0;
    stack[depth++] = (build_task){0, 0, count, 0};
    b->node_count = 1;
    while (depth > 0) {
        build_task task = stack[--depth];
        alpi_light_bound all = EMPTY;
        for (uint32_t i = task.first; i < task.last; i++) {
            all = join(&all, &b->bounds[b->order[i]]);
        }
        tree_node *node = &b->tree->nodes[task.node];
        fill_node(node, &all);
        if (task.last - task.first == 1) {
            node->light = b->order[task.first];
            b->tree->leaf[node->light] = task.node;
            continue;
        }
        uint32_t half = task.first + (task.last - task.first) / 2;
        if (task.depth < EVEN_DEPTH) {
            split s = find_split(b, &task, &all);
            half = s.axis < 0 ? half : part(b, &task, &s, scratch);
        }
        node->child = b->node_count;
        b->node_count += 2;
        b->tree->nodes[node->child].parent = b->tree->nodes[node->child + 1].parent = task.node;
        stack[depth++] = (build_task){node->child + 1, half, task.last, task.depth + 1};
        stack[depth++] = (build_task){node->child, task.first, half, task.depth + 1};
    }
}

alp_result alpi_light_tree_create(alp_context *context, const alpi_light_bound *bounds,
                                  uint32_t count, alpi_light_tree **tree)
{
    *tree = ALPI_NEW(context, alpi_light_tree, 1);
    uint32_t *order = ALPI_NEW(context, uint32_t, count);
    uint32_t *scratch = ALPI_NEW(context, uint32_t, count);
    if (*tree != NULL) {
        (*tree)->nodes = ALPI_NEW(context, tree_node, 2 * (size_t)count - 1);
        (*tree)->leaf = ALPI_NEW(context, uint32_t, count);
    }
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (order != NULL && scratch != NULL && *tree != NULL && (*tree)->nodes != NULL &&
        (*tree)->leaf != NULL) {
        for (uint32_t i = 0; i < count; i++) {
            order[i] = i;
        }
        build(&(builder){.bounds = bounds, .order = order, .tree = *tree}, count, scratch);
        result = ALP_OK;
    } else {
        alpi_light_tree_destroy(context, *tree);
        *tree = NULL;
    }
    alpi_release(context, order);
    alpi_release(context, scratch);
    return result;
}

void alpi_light_tree_destroy(alp_context *context, alpi_light_tree *tree)
{
    if (tree != NULL) {
        alpi_release(context, tree->nodes);
        alpi_release(context, tree->leaf);
        alpi_release(context, tree);
    }
}

// --- drawing -------------------------------------------------------------------------------------

/// Cosine of max(a − b, 0).
static double cos_less(double cos_a, double sin_a, double cos_b, double sin_b)
{
    return cos_a >= cos_b ? 1.0 : cos_a * cos_b + sin_a * sin_b;
}

/// Sine of max(a − b, 0).
static double sin_less(double cos_a, double sin_a, double cos_b, double sin_b)
{
    return cos_a >= cos_b ? 0.0 : fmax(sin_a * cos_b - cos_a * sin_b, 0.0);
}

static double sine_of(double cosine)
{
    return sqrt(fmax(1.0 - cosine * cosine, 0.0));
}

/// Power × cosines at both ends / distance². Each cosine is halfway between the largest that there
/// may be, which is the paper's and never 0 where light may be, and that of the middle, which is
/// nearer to the truth: for lamps in a ceiling that is less than half the deviation
/// (tests/analytic/test_emitters.c).
static double importance(const tree_node *node, vec3 point, vec3 normal)
{
    double3 to = double3_between(point, node->center);
    double distance2 = double3_dot(to, to), radius2 = (double)node->radius * (double)node->radius;
    if (distance2 <= radius2 || !(distance2 > 1e-60)) { // inside: anything may be
        return node->power / fmax(fmax(distance2, 0.5 * radius2), 1e-60);
    }
    double distance = sqrt(distance2);
    double sin_wide = (double)node->radius / distance, cos_wide = sqrt(1.0 - sin_wide * sin_wide);
    double cos_here = double3_dot(to, double3_from(normal)) / distance;
    double here = cos_less(cos_here, sine_of(cos_here), cos_wide, sin_wide);
    double cos_there = -double3_dot(to, double3_from(node->axis)) / distance;
    cos_there = node->two_sided ? fabs(cos_there) : cos_there;
    double sin_there = sine_of(cos_there);
    double cos_cone = (double)node->cos_cone, sin_cone = (double)node->sin_cone;
    double cos_free = cos_less(cos_there, sin_there, cos_cone, sin_cone);
    double sin_free = sin_less(cos_there, sin_there, cos_cone, sin_cone);
    double there = cos_less(cos_free, sin_free, cos_wide, sin_wide);
    // Cosines are right to float, so is where light ends.
    const double slack = 1e-6;
    if (here <= -slack || there <= (double)node->cos_reach - slack) {
        return 0.0;
    }
    here = 0.5 * (fmax(here, slack) + fmax(cos_here, 0.0));
    there = 0.5 * (fmax(there, slack) + fmax(cos_free, 0.0));
    return node->power * here * there / distance2;
}

double alpi_light_tree_importance(const alpi_light_tree *tree, vec3 point, vec3 normal)
{
    return importance(&tree->nodes[0], point, normal);
}

/// Probability of the first of two siblings; −1 when neither can give anything.
static double share_of_first(const tree_node *pair, vec3 point, vec3 normal)
{
    double first = importance(&pair[0], point, normal);
    double second = importance(&pair[1], point, normal);
    return first + second > 0.0 ? first / (first + second) : -1.0;
}

double alpi_light_tree_sample(const alpi_light_tree *tree, vec3 point, vec3 normal, double pick,
                              uint32_t *light)
{
    const tree_node *node = &tree->nodes[0];
    double probability = 1.0;
    while (node->child != 0) {
        const tree_node *pair = &tree->nodes[node->child];
        double share = share_of_first(pair, point, normal);
        if (share < 0.0) {
            return 0.0;
        }
        bool first = pick < share;
        double part = first ? share : 1.0 - share;
        pick = first ? pick / part : (pick - share) / part;
        pick = fmin(pick, 1.0 - 0x1p-53);
        probability *= part;
        node = first ? pair : pair + 1;
    }
    *light = node->light;
    return probability;
}

double alpi_light_tree_probability(const alpi_light_tree *tree, vec3 point, vec3 normal,
                                   uint32_t light)
{
    const tree_node *nodes = tree->nodes;
    double probability = 1.0;
    for (uint32_t i = tree->leaf[light]; i != 0; i = nodes[i].parent) {
        uint32_t first = nodes[nodes[i].parent].child;
        double share = share_of_first(&nodes[first], point, normal);
        if (share < 0.0) {
            return 0.0;
        }
        probability *= i == first ? share : 1.0 - share;
    }
    return probability;
}
