// SPDX-License-Identifier: MIT
// The look-up of the ambience volume, included once for each instruction set. No fused operations
// in either: the same bits.
#include "base/octahedral.h"
#include "fields/ambience/ambience_snapshot.h"
#include "transport/lane_loop.h"

#include <math.h>
#include <string.h>

enum { CORNERS = 8, SIDE = 8 };
_Static_assert((int)ALPI_PACKET == (int)CORNERS, "a lane for each corner");
/// Below this sum of weights, a level gives way to the next.
static const float SCARCE = 0.004f;
/// Cells above a surface from where anchors are seen.
static const float LIFT = 0.25f;
/// A rest of confidence below this is left out.
static const float NOTHING = 1e-6f;

/// The lattice of a level round a point. Bit k of a corner: the upper one on axis k.
typedef struct level_lattice {
    int32_t low[3];
    float part[3]; // [0, 1) from the lower to the upper
    uint32_t node[CORNERS];
} level_lattice;

typedef struct point_search {
    const alp_ambience_snapshot *s;
    double unit[3]; // the point in units; flat: 0 along y
    float height;   // flat: metres of the point along y
    vec3 lift;      // from the point to where anchors are seen from, in cells
    level_lattice levels[ALPI_GRAPH_LEVELS];
} point_search;

static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

// --- search --------------------------------------------------------------------------------------

static inline void place_lattice(const point_search *p, uint32_t level, level_lattice *l)
{
    for (int k = 0; k < 3; k++) {
        const double x = p->unit[k] * p->s->level_scale[level];
        const int32_t cut = (int32_t)x;
        l->low[k] = cut - (x < (double)cut ? 1 : 0);
        l->part[k] = (float)(x - (double)l->low[k]);
    }
}

static void find_root(const point_search *p, level_lattice *l)
{
    const int32_t *root = p->s->root_index;
    for (uint32_t c = 0; c < CORNERS; c++) {
        bool same = true;
        for (int k = 0; k < 3; k++) {
            same = same && l->low[k] + (int32_t)(c >> k & 1u) == root[k];
        }
        l->node[c] = same ? ALPI_GRAPH_ROOT : ALPI_NO_NODE;
    }
}

/// Finds the nodes of a level among the children of those of the level above. The parents of the
/// places round a point are among those round it one level up: |x/3 − parent| ≤ 2/3.
static inline bool find_children(const point_search *p, const level_lattice *above,
                                 level_lattice *l)
{
    static const uint32_t strides[2][3] = {{1, 3, 9}, {1, 0, 3}};
    const uint32_t *stride = strides[p->s->flat];
    uint32_t parent[3][2], place[3][2];
    bool any = false;
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 2; i++) { // −1 to 4 from the lower parent's middle child
            const int32_t from = l->low[k] + i - 3 * above->low[k];
            const uint32_t upper = from > 1 ? 1 : 0;
            parent[k][i] = upper << k;
            place[k][i] = (uint32_t)(from + 1 - 3 * (int32_t)upper) * stride[k];
        }
    }
    for (uint32_t c = 0; c < CORNERS; c++) {
        const uint32_t x = c & 1u, y = c >> 1 & 1u, z = c >> 2;
        const uint32_t from = above->node[parent[0][x] | parent[1][y] | parent[2][z]];
        l->node[c] = ALPI_NO_NODE;
        if (from != ALPI_NO_NODE && p->s->nodes[from].child != ALPI_NO_NODE) {
            l->node[c] = p->s->nodes[from].child + place[0][x] + place[1][y] + place[2][z];
            any = true;
        }
    }
    return any;
}

/// @return the finest level with nodes round the point
static inline uint32_t find_levels(point_search *p)
{
    uint32_t level = p->s->root_level;
    place_lattice(p, level, &p->levels[level]);
    find_root(p, &p->levels[level]);
    while (level > 0) {
        place_lattice(p, level - 1, &p->levels[level - 1]);
        if (!find_children(p, &p->levels[level], &p->levels[level - 1])) {
            break;
        }
        level--;
    }
    return level;
}

// --- weights -------------------------------------------------------------------------------------

/// The anchors round a point at a level, lane by lane.
typedef struct level_anchors {
    const alpi_read_anchor *anchor[CORNERS]; // NULL: none, or without light
    _Alignas(32) float trilinear[CORNERS], confidence[CORNERS], open[CORNERS], seen[CORNERS];
} level_anchors;

/// @return whether any has light
static inline bool find_anchors(const point_search *p, const level_lattice *l, level_anchors *at)
{
    const alp_ambience_snapshot *s = p->s;
    bool any = false;
    ALPI_EACH_LANE
    {
        const float x = l->part[0], y = l->part[1], z = l->part[2];
        at->trilinear[i] = ((i & 1) != 0 ? x : 1.0f - x) * ((i >> 1 & 1) != 0 ? y : 1.0f - y) *
                           ((i >> 2) != 0 ? z : 1.0f - z);
    }
    for (int i = 0; i < CORNERS; i++) {
        const alpi_read_node *node = l->node[i] != ALPI_NO_NODE ? &s->nodes[l->node[i]] : NULL;
        at->anchor[i] = NULL;
        at->confidence[i] = 0.0f;
        at->open[i] = 1.0f;
        at->seen[i] = 1.0f;
        if (node != NULL && node->anchor != ALPI_NO_ANCHOR) {
            const alpi_read_anchor *a = &s->anchors[node->anchor];
            at->open[i] = a->open;
            if (a->confidence > 0.0f && a->slot != ALPI_NO_SLOT && at->trilinear[i] > 0.0f) {
                at->anchor[i] = a;
                at->confidence[i] = a->confidence < node->share ? a->confidence : node->share;
                any = any || at->confidence[i] > 0.0f;
            }
        }
    }
    return any;
}

/// Texel (x, y) of an octahedral map that continues round the sphere; x, y in [−1, SIDE].
static inline uint32_t wrapped(int x, int y)
{
    if (y < 0 || y >= SIDE) {
        x = SIDE - 1 - x;
        y = y < 0 ? 0 : SIDE - 1;
    }
    if (x < 0 || x >= SIDE) {
        y = SIDE - 1 - y;
        x = x < 0 ? 0 : SIDE - 1;
    }
    return (uint32_t)(y * SIDE + x);
}

/// Mean distance and mean of its square that an anchor met in a direction.
static inline vec2 read_moments(const float (*moments)[2], vec3 way)
{
    const vec2 uv = alpi_octahedral_encode(way);
    const float u = uv.x * SIDE + 0.5f, v = uv.y * SIDE + 0.5f; // ≥ .5
    const int column = (int)u, row = (int)v;
    const float a = u - (float)column, b = v - (float)row;
    const int x = column - 1, y = row - 1;
    const float *m[4] = {moments[wrapped(x, y)], moments[wrapped(x + 1, y)],
                         moments[wrapped(x, y + 1)], moments[wrapped(x + 1, y + 1)]};
    const float w[4] = {(1.0f - a) * (1.0f - b), a * (1.0f - b), (1.0f - a) * b, a * b};
    vec2 found = {0.0f, 0.0f};
    for (int i = 0; i < 4; i++) {
        found.x += w[i] * m[i][0];
        found.y += w[i] * m[i][1];
    }
    return found;
}

/// Finds how well anchors see the point: max(.05, (v / (v + (d − m₁)²))³), crushed below .2.
static inline void find_seen(const point_search *p, uint32_t level, const level_lattice *l,
                             level_anchors *at)
{
    const alp_ambience_snapshot *s = p->s;
    const float cell = (float)(s->unit * (double)alpi_graph_width(level));
    for (int i = 0; i < CORNERS; i++) {
        const alpi_read_anchor *a = at->anchor[i];
        if (a == NULL) {
            continue;
        }
        vec3 way = {(l->part[0] - (float)(i & 1)) * cell, (l->part[1] - (float)(i >> 1 & 1)) * cell,
                    (l->part[2] - (float)(i >> 2)) * cell};
        if (s->flat) {
            way.y = p->height - a->height;
        }
        way = vec3_mad(way, cell, p->lift);
        const float distance = sqrtf(vec3_dot(way, way));
        if (distance <= a->clear) {
            continue;
        }
        const vec2 m = read_moments((const float(*)[2])s->moments[a->slot], way);
        const float beyond = larger(distance - m.x, 0.0f);
        const float variance = fabsf(m.y - m.x * m.x) + 1e-12f;
        const float share = variance / (variance + beyond * beyond);
        const float w = larger(share * share * share, 0.05f);
        at->seen[i] = w < 0.2f ? w * w * w * 25.0f : w;
    }
}

// --- sums ----------------------------------------------------------------------------------------

static inline void add_light(const point_search *p, const level_anchors *at,
                             const float weight[CORNERS], float light[ALPI_AMBIENCE_FLOATS])
{
    for (int c = 0; c < CORNERS; c++) {
        if (at->anchor[c] != NULL) {
            const float *restrict from = p->s->light[at->anchor[c]->slot];
            const float w = weight[c];
            for (int i = 0; i < ALPI_AMBIENCE_FLOATS; i++) {
                light[i] += w * from[i];
            }
        }
    }
}

/// Adds the light of a level. @return what is left of `rest`
static inline float add_level(const point_search *p, uint32_t level, float rest,
                              float light[ALPI_AMBIENCE_FLOATS])
{
    const level_lattice *l = &p->levels[level];
    level_anchors at;
    _Alignas(32) float all[CORNERS], weight[CORNERS];
    float sum = 0.0f, trusted = 0.0f;
    if (!find_anchors(p, l, &at)) {
        return rest;
    }
    if (p->s->moments != NULL) {
        find_seen(p, level, l, &at);
    }
    ALPI_EACH_LANE
    {
        const float f = at.confidence[i];
        all[i] = at.trilinear[i] * at.open[i] * (1.0f - f + f * at.seen[i]);
        weight[i] = all[i] * f;
    }
    for (int i = 0; i < CORNERS; i++) {
        sum += all[i];
        trusted += weight[i];
    }
    if (!(trusted > 0.0f)) {
        return rest;
    }
    const float scale = rest * (sum < SCARCE ? 1.0f / SCARCE : 1.0f / sum);
    for (int i = 0; i < CORNERS; i++) {
        weight[i] *= scale;
    }
    add_light(p, &at, weight, light);
    return rest - trusted * scale;
}

/// The rule of 2006, at one level: anchors round the point, weighed by 1 / distance. They have all
/// of `rest`. @return what is left of it
static inline float add_octants(const point_search *p, uint32_t level, float rest,
                                float light[ALPI_AMBIENCE_FLOATS])
{
    const level_lattice *l = &p->levels[level];
    level_anchors at;
    float weight[CORNERS], total = 0.0f;
    if (!find_anchors(p, l, &at)) {
        return rest;
    }
    for (int i = 0; i < CORNERS; i++) {
        const float way[3] = {l->part[0] - (float)(i & 1), l->part[1] - (float)(i >> 1 & 1),
                              l->part[2] - (float)(i >> 2)};
        const float square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
        weight[i] = at.anchor[i] != NULL ? 1.0f / larger(sqrtf(square), 1e-6f) : 0.0f;
        total += weight[i];
    }
    for (int i = 0; i < CORNERS; i++) {
        weight[i] *= rest / total;
    }
    add_light(p, &at, weight, light);
    return 0.0f;
}

// --- all -----------------------------------------------------------------------------------------

bool ALPI_VARIANT(alpi_ambience_lookup)(const alp_ambience_snapshot *snapshot,
                                        const double position[3], const float *normal,
                                        float light[ALPI_AMBIENCE_FLOATS])
{
    point_search p;
    float sums[ALPI_AMBIENCE_FLOATS] = {0.0f}, rest = snapshot->dawn;
    const bool ours = snapshot->lookup == ALP_AMBIENCE_OURS;
    p.s = snapshot;
    p.height = (float)position[1];
    p.lift = normal != NULL ? vec3_scale(vec3_load(normal), LIFT) : (vec3){0.0f, 0.0f, 0.0f};
    memset(light, 0, ALPI_AMBIENCE_FLOATS * sizeof *light);
    for (int k = 0; k < 3; k++) {
        p.unit[k] = (position[k] - snapshot->centre[k]) * snapshot->inverse_unit;
        if (!(fabs(p.unit[k]) < 1e9)) {
            return false;
        }
    }
    p.unit[1] = snapshot->flat ? 0.0 : p.unit[1];
    for (uint32_t level = find_levels(&p); level <= snapshot->depth && rest > NOTHING; level++) {
        rest = ours ? add_level(&p, level, rest, sums) : add_octants(&p, level, rest, sums);
    }
    for (int i = 0; i < ALPI_AMBIENCE_FLOATS; i++) {
        light[i] = sums[i] + (rest > NOTHING ? rest * snapshot->base[i] : 0.0f);
    }
    return true;
}
