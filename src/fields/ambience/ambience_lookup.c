// SPDX-License-Identifier: MIT
#include "base/octahedral.h"
#include "fields/ambience/ambience_snapshot.h"

#include <math.h>
#include <string.h>

enum { CORNERS = 8, SIDE = 8 };
/// Below this sum of weights, a level gives way to the next.
static const float SCARCE = 0.1f;
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
    double unit[3]; // the point in units
    level_lattice levels[ALPI_GRAPH_LEVELS];
} point_search;

// --- search --------------------------------------------------------------------------------------

static void place_lattice(const point_search *p, uint32_t level, level_lattice *l)
{
    const double scale = 1.0 / (double)alpi_graph_width(level);
    for (int k = 0; k < 3; k++) {
        const double x = p->s->flat && k == 1 ? 0.0 : p->unit[k] * scale;
        const double low = floor(x);
        l->low[k] = (int32_t)low;
        l->part[k] = (float)(x - low);
    }
}

static int32_t corner_index(const level_lattice *l, uint32_t corner, int axis)
{
    return l->low[axis] + (int32_t)(corner >> axis & 1u);
}

static void find_root(const point_search *p, level_lattice *l)
{
    const int32_t *root = p->s->root_index;
    for (uint32_t c = 0; c < CORNERS; c++) {
        const bool same = corner_index(l, c, 0) == root[0] && corner_index(l, c, 1) == root[1] &&
                          corner_index(l, c, 2) == root[2];
        l->node[c] = same ? ALPI_GRAPH_ROOT : ALPI_NO_NODE;
    }
}

/// Finds the nodes of a level among the children of those of the level above. The parents of the
/// places round a point are among those round it one level up: |x/3 − parent| ≤ 2/3.
static bool find_children(const point_search *p, const level_lattice *above, level_lattice *l)
{
    uint32_t parent[3][2], step[3][2];
    bool any = false;
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 2; i++) {
            const int32_t index = l->low[k] + i, up = alpi_graph_parent_index(index);
            parent[k][i] = (uint32_t)(up - above->low[k]);
            step[k][i] = (uint32_t)(index - 3 * up + 1);
        }
    }
    for (uint32_t c = 0; c < CORNERS; c++) {
        const uint32_t x = c & 1u, y = c >> 1 & 1u, z = c >> 2;
        const uint32_t from =
            above->node[parent[0][x] | parent[1][y] << 1 | parent[2][z] << 2];
        l->node[c] = ALPI_NO_NODE;
        if (from != ALPI_NO_NODE && p->s->nodes[from].child != ALPI_NO_NODE) {
            const uint32_t place = p->s->flat ? step[0][x] + 3 * step[2][z]
                                              : step[0][x] + 3 * step[1][y] + 9 * step[2][z];
            l->node[c] = p->s->nodes[from].child + place;
            any = true;
        }
    }
    return any;
}

/// @return the finest level with nodes round the point
static uint32_t find_levels(point_search *p)
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

/// How well an anchor sees a point: max(.05, (v / (v + (d − m₁)²))³), crushed below .2.
static float visibility(const float (*moments)[2], vec3 way)
{
    const float distance = vec3_length(way);
    if (!(distance > 0.0f)) {
        return 1.0f;
    }
    const vec2 uv = alpi_octahedral_encode(way);
    const float u = uv.x * SIDE - 0.5f, v = uv.y * SIDE - 0.5f;
    const float column = floorf(u), row = floorf(v), a = u - column, b = v - row;
    const int x = (int)column, y = (int)row;
    const float *m[4] = {moments[wrapped(x, y)], moments[wrapped(x + 1, y)],
                         moments[wrapped(x, y + 1)], moments[wrapped(x + 1, y + 1)]};
    const float w[4] = {(1.0f - a) * (1.0f - b), a * (1.0f - b), (1.0f - a) * b, a * b};
    float mean = 0.0f, square = 0.0f;
    for (int i = 0; i < 4; i++) {
        mean += w[i] * m[i][0];
        square += w[i] * m[i][1];
    }
    const float beyond = fmaxf(distance - mean, 0.0f);
    const float variance = fabsf(square - mean * mean) + 1e-12f;
    const float share = variance / (variance + beyond * beyond);
    const float seen = fmaxf(share * share * share, 0.05f);
    return seen < 0.2f ? seen * seen * seen * 25.0f : seen;
}

/// From an anchor to the point, metres.
static vec3 way_from(const point_search *p, uint32_t level, const level_lattice *l, uint32_t corner,
                     const alpi_read_anchor *anchor)
{
    const double cell = p->s->unit * (double)alpi_graph_width(level);
    float way[3];
    for (int k = 0; k < 3; k++) {
        way[k] = (l->part[k] - (float)(corner >> k & 1u)) * (float)cell;
    }
    if (p->s->flat) {
        way[1] = (float)(p->unit[1] * p->s->unit + p->s->centre[1]) - anchor->height;
    }
    return (vec3){way[0], way[1], way[2]};
}

static float trilinear(const point_search *p, const level_lattice *l, uint32_t corner)
{
    float t = 1.0f;
    for (int k = 0; k < 3; k++) {
        const float upper = p->s->flat && k == 1 ? 0.0f : l->part[k];
        t *= (corner >> k & 1u) != 0 ? upper : 1.0f - upper;
    }
    return t;
}

static const alpi_read_anchor *anchor_at(const alp_ambience_snapshot *s, uint32_t node)
{
    if (node == ALPI_NO_NODE || s->nodes[node].anchor == ALPI_NO_ANCHOR) {
        return NULL;
    }
    return &s->anchors[s->nodes[node].anchor];
}

/// Adds the light of a level. @return what is left of `rest`
static float add_level(const point_search *p, uint32_t level, float rest,
                       float light[ALPI_AMBIENCE_FLOATS])
{
    const alp_ambience_snapshot *s = p->s;
    const level_lattice *l = &p->levels[level];
    float weight[CORNERS], sum = 0.0f, trusted = 0.0f;
    const alpi_read_anchor *anchors[CORNERS];
    for (uint32_t c = 0; c < CORNERS; c++) {
        const alpi_read_anchor *a = anchor_at(s, l->node[c]);
        float w = trilinear(p, l, c);
        anchors[c] = a;
        weight[c] = 0.0f;
        if (a != NULL && w > 0.0f) {
            const float confidence = fminf(a->confidence, s->nodes[l->node[c]].share);
            w *= a->open;
            if (s->moments != NULL && confidence > 0.0f) {
                const float seen = visibility((const float(*)[2])s->moments[a - s->anchors],
                                              way_from(p, level, l, c, a));
                w *= 1.0f - confidence + confidence * seen;
            }
            weight[c] = w * confidence;
        }
        sum += w;
        trusted += weight[c];
    }
    if (!(trusted > 0.0f)) {
        return rest;
    }
    const float scale = rest * fminf(1.0f, sum / SCARCE) / sum;
    for (uint32_t c = 0; c < CORNERS; c++) {
        const float w = weight[c] * scale;
        for (int i = 0; i < ALPI_AMBIENCE_FLOATS && w > 0.0f; i++) {
            light[i] += w * anchors[c]->light[i];
        }
    }
    return rest - trusted * scale;
}

// --- conformance ---------------------------------------------------------------------------------

/// The rule of 2006. From the finest node that holds the point upwards: of each octant round the
/// node's centre the nearest anchor among the node and its neighbours, weighed by 1 / distance.
static float add_octants(const point_search *p, uint32_t level, float light[ALPI_AMBIENCE_FLOATS])
{
    const alp_ambience_snapshot *s = p->s;
    const level_lattice *l = &p->levels[level];
    float total = 0.0f, sums[ALPI_AMBIENCE_FLOATS] = {0.0f};
    for (uint32_t c = 0; c < CORNERS; c++) {
        const alpi_read_anchor *a = anchor_at(s, l->node[c]);
        if (a == NULL || !(a->confidence > 0.0f) || (s->flat && (c >> 1 & 1u) != 0)) {
            continue;
        }
        const float w = 1.0f / fmaxf(vec3_length(way_from(p, level, l, c, a)), 1e-6f);
        for (int i = 0; i < ALPI_AMBIENCE_FLOATS; i++) {
            sums[i] += w * a->light[i];
        }
        total += w;
    }
    for (int i = 0; i < ALPI_AMBIENCE_FLOATS && total > 0.0f; i++) {
        light[i] = sums[i] / total;
    }
    return total > 0.0f ? 0.0f : 1.0f;
}

// --- all -----------------------------------------------------------------------------------------

bool alpi_ambience_read(const alp_ambience_snapshot *snapshot, const double position[3],
                        float light[ALPI_AMBIENCE_FLOATS])
{
    point_search p;
    p.s = snapshot;
    memset(light, 0, ALPI_AMBIENCE_FLOATS * sizeof *light);
    for (int k = 0; k < 3; k++) {
        p.unit[k] = (position[k] - snapshot->centre[k]) / snapshot->unit;
        if (!(fabs(p.unit[k]) < 1e9)) {
            return false;
        }
    }
    float rest = 1.0f;
    const bool ours = snapshot->lookup == ALP_AMBIENCE_OURS;
    for (uint32_t level = find_levels(&p); level <= snapshot->depth && rest > NOTHING;
         level++) {
        rest = ours ? add_level(&p, level, rest, light) : add_octants(&p, level, light);
    }
    for (int i = 0; i < ALPI_AMBIENCE_FLOATS && rest > NOTHING; i++) {
        light[i] += rest * snapshot->base[i];
    }
    return true;
}

void alp_ambience_coefficients(const alp_ambience_snapshot *snapshot, const double position[3],
                               alp_sh9 *radiance)
{
    if (snapshot == NULL || radiance == NULL) {
        return;
    }
    float light[ALPI_AMBIENCE_FLOATS];
    alpi_ambience_read(snapshot, position, light);
    memcpy(radiance->c, light, sizeof light);
}

void alp_ambience_irradiance(const alp_ambience_snapshot *snapshot, uint32_t count,
                             const double (*positions)[3], const float (*normals)[3],
                             float (*irradiance)[3])
{
    for (uint32_t i = 0; snapshot != NULL && i < count; i++) {
        alpi_sh9 radiance;
        const vec3 normal = vec3_load(normals[i]);
        alp_ambience_coefficients(snapshot, positions[i], &radiance);
        const vec3 e = vec3_is_finite(normal) ? alpi_sh9_irradiance(&radiance, normal)
                                              : (vec3){0.0f, 0.0f, 0.0f};
        irradiance[i][0] = fmaxf(e.x, 0.0f);
        irradiance[i][1] = fmaxf(e.y, 0.0f);
        irradiance[i][2] = fmaxf(e.z, 0.0f);
    }
}
