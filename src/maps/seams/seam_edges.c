// SPDX-License-Identifier: MIT
#include "maps/seams/seam_edges.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "scene/adjacency.h"
#include "scene/double3.h"

#include <math.h>

enum { EDGES_PER_TICK = 1 << 12, LOOK_LIMIT = 4096 };
enum { EDGES_PER_PART = 64, PARTS = EDGES_PER_TICK / EDGES_PER_PART }; // searched side by side
/// Found in a part, at which it stops: where everything meets everything, pairs would fill memory.
enum { PAIR_LIMIT = 256 };
/// How far edges that meet may lie apart: so much of the finer texel, and what rounding does of a
/// coordinate, but no more of a texel than the limit. Far from the origin rounding is as long as
/// texels, and says nothing any more about who is whose neighbour.
static const double APART = 0.1, ROUNDING = 4e-7, ROUNDING_LIMIT = 0.15;

static double3 load(const float position[3])
{
    return double3_from(vec3_load(position));
}

// --- which edges ---------------------------------------------------------------------------------

/// The edge of `triangle` whose other side is half-edge (from, to) of a mesh, by positions.
static int find_opposite(const alp_scene *scene, uint32_t triangle, const float *from,
                         const float *to)
{
    const uint32_t *corners = scene->triangles[triangle];
    for (int k = 0; k < 3; k++) {
        const float *a = scene->positions[corners[k]];
        const float *b = scene->positions[corners[(k + 1) % 3]];
        if (a[0] == to[0] && a[1] == to[1] && a[2] == to[2] && b[0] == from[0] && b[1] == from[1] &&
            b[2] == from[2]) {
            return k;
        }
    }
    return -1;
}

/// Whether corner j of one triangle and corner k of another read the same place in all sets, and
/// are lit alike.
static bool is_same_corner(const alp_lightmap *l, const uint32_t triangles[2], int j, int k)
{
    const float uv_limit = 1e-3f; // texels
    const vec3 m = vec3_load(l->scene->normals[l->scene->triangles[triangles[0]][j]]);
    const vec3 n = vec3_load(l->scene->normals[l->scene->triangles[triangles[1]][k]]);
    bool same = (double)vec3_dot(m, n) >= ALPI_SEAM_COSINE;
    for (int set = 0; set < alpi_atlas_set_count(l->atlas) && same; set++) {
        const float *p = alpi_atlas_set_uv(l->atlas, triangles[0], set, j);
        const float *q = alpi_atlas_set_uv(l->atlas, triangles[1], set, k);
        same = fabsf(p[0] - q[0]) * (float)l->width <= uv_limit &&
               fabsf(p[1] - q[1]) * (float)l->height <= uv_limit;
    }
    return same;
}

/// Whether a look-up goes on from one triangle to the other across edge k of the first.
static bool goes_on(const alp_lightmap *l, uint32_t triangle, int k, uint32_t neighbour)
{
    const alp_scene *s = l->scene;
    const uint32_t *pages = l->atlas->triangle_pages;
    if (neighbour == ALPI_NONE || pages[neighbour] != pages[triangle]) {
        return false;
    }
    const int next = (k + 1) % 3;
    const int other = find_opposite(s, neighbour, s->positions[s->triangles[triangle][k]],
                                    s->positions[s->triangles[triangle][next]]);
    const uint32_t both[2] = {triangle, neighbour};
    return other >= 0 && is_same_corner(l, both, k, (other + 1) % 3) &&
           is_same_corner(l, both, next, other);
}

static alpi_seam_edge make_edge(const alp_lightmap *l, uint32_t triangle, uint32_t k)
{
    const uint32_t next = (k + 1) % 3;
    const float *p = l->atlas->corner_uvs[triangle][k], *q = l->atlas->corner_uvs[triangle][next];
    const double du = ((double)q[0] - (double)p[0]) * l->width;
    const double dv = ((double)q[1] - (double)p[1]) * l->height;
    const uint32_t *corners = l->scene->triangles[triangle];
    const double length = double3_length(double3_sub(load(l->scene->positions[corners[next]]),
                                                     load(l->scene->positions[corners[k]])));
    return (alpi_seam_edge){.half_edge = 3 * triangle + k,
                            .length = (float)length,
                            .texel = (float)(length / fmax(sqrt(du * du + dv * dv), 1.0))};
}

static alp_result collect(const alp_lightmap *l, const uint32_t (*neighbours)[3],
                          alpi_seam_edges *edges)
{
    const alp_scene *s = l->scene;
    size_t capacity = 0;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        if (t % EDGES_PER_TICK == 0) {
            ALP_TRY(alpi_tick(s->context, "seams", t, s->triangle_count));
        }
        if (!s->triangle_usable[t] || l->atlas->triangle_pages[t] == ALPI_NONE) {
            continue;
        }
        for (uint32_t k = 0; k < 3; k++) {
            if (goes_on(l, t, (int)k, neighbours[t][k])) {
                continue;
            }
            ALP_TRY(alpi_grow(s->context, (void **)&edges->edges, &capacity,
                              (size_t)edges->count + 1, sizeof *edges->edges));
            const alpi_seam_edge edge = make_edge(l, t, k);
            edges->edges[edges->count] = edge;
            edges->count += edge.length > 0.0f ? 1 : 0;
        }
    }
    return ALP_OK;
}

alp_result alpi_seam_edges_create(const alp_lightmap *lightmap, alpi_seam_edges *edges)
{
    *edges = (alpi_seam_edges){.context = lightmap->context};
    uint32_t(*neighbours)[3] = NULL;
    ALP_TRY(alpi_adjacency_create(lightmap->scene, &neighbours));
    const alp_result result = collect(lightmap, (const uint32_t(*)[3])neighbours, edges);
    alpi_release(lightmap->context, neighbours);
    if (result != ALP_OK) {
        alpi_seam_edges_destroy(edges);
    }
    return result;
}

void alpi_seam_edges_destroy(alpi_seam_edges *edges)
{
    if (edges->context != NULL) {
        alpi_release(edges->context, edges->edges);
    }
    *edges = (alpi_seam_edges){0};
}

// --- which of them meet --------------------------------------------------------------------------
// A hash grid for each octave of lengths, with cells of one to two lengths; an edge stands in the
// cell of its middle. Each edge looks for those that are as long or longer, so that it looks at few
// cells however long it is itself. Edges with the same ends, bit for bit, stand in the same cell;
// one across which the surface goes on so needs no other partner, and looks at that cell alone.

typedef struct cell {
    int64_t x[3];
    int octave;
} cell;

/// What tells most of those that meet nothing, side by side in memory.
typedef struct entry {
    uint32_t edge;
    float length;
    float middle[3]; // metres
} entry;

typedef struct pair_search {
    const alp_scene *scene;
    const alpi_seam_edges *edges;
    uint32_t *first;  // [buckets + 1]
    entry *sorted;    // [edges] bucket by bucket
    uint8_t *settled; // [edges] 1: the surface goes on at an edge with the same ends
    uint32_t mask;
    int highest;       // octave
    bool octaves[512]; // by octave + 256: whether there are edges of it; of floats there are 277
} pair_search;

/// Pairs of a part of the edges, in the order in which they were found.
typedef struct found_pairs {
    alpi_seam_pair *pairs;
    size_t count, capacity;
    uint32_t next, end; // edges that are left
} found_pairs;

static int octave_of(float length)
{
    return ilogbf(length) + 1;
}

/// The corners of an edge: vertices of the scene.
static void edge_corners(const alp_scene *scene, const alpi_seam_edge *edge, uint32_t corners[2])
{
    const uint32_t *all = scene->triangles[edge->half_edge / 3];
    corners[0] = all[edge->half_edge % 3];
    corners[1] = all[(edge->half_edge % 3 + 1) % 3];
}

static void edge_ends(const alp_scene *scene, const alpi_seam_edge *edge, double3 ends[2])
{
    uint32_t corners[2];
    edge_corners(scene, edge, corners);
    ends[0] = load(scene->positions[corners[0]]);
    ends[1] = load(scene->positions[corners[1]]);
}

static uint32_t hash_cell(const pair_search *s, const cell *c)
{
    uint64_t h = alpi_hash64((uint64_t)c->x[0] ^ (uint64_t)(c->octave + 512) << 48);
    h = alpi_hash64(h ^ (uint64_t)c->x[1]);
    return (uint32_t)(alpi_hash64(h ^ (uint64_t)c->x[2]) >> 32) & s->mask;
}

/// Cells are counted up to 2^60: beyond, an edge is shorter than its coordinates are exact.
static int64_t find_cell(double coordinate, double size)
{
    const double limit = 0x1p60;
    return (int64_t)fmin(fmax(floor(coordinate / size), -limit), limit);
}

static double3 middle_of(const pair_search *s, const alpi_seam_edge *edge)
{
    double3 ends[2];
    edge_ends(s->scene, edge, ends);
    return double3_scale(double3_add(ends[0], ends[1]), 0.5);
}

static cell cell_of(const pair_search *s, const alpi_seam_edge *edge)
{
    const double3 middle = middle_of(s, edge);
    cell c = {.octave = octave_of(edge->length)};
    const double size = ldexp(1.0, c.octave);
    c.x[0] = find_cell(middle.x, size);
    c.x[1] = find_cell(middle.y, size);
    c.x[2] = find_cell(middle.z, size);
    return c;
}

static entry make_entry(const pair_search *s, uint32_t edge)
{
    const alpi_seam_edge *e = &s->edges->edges[edge];
    const double3 m = middle_of(s, e);
    return (entry){edge, e->length, {(float)m.x, (float)m.y, (float)m.z}};
}

static alp_result sort_edges(pair_search *s, uint32_t *buckets)
{
    const alpi_seam_edges *e = s->edges;
    s->highest = INT32_MIN;
    for (uint32_t i = 0; i < e->count; i++) {
        const cell c = cell_of(s, &e->edges[i]);
        buckets[i] = hash_cell(s, &c);
        s->first[buckets[i]]++;
        s->highest = c.octave > s->highest ? c.octave : s->highest;
        s->octaves[c.octave + 256] = true;
        if (i % EDGES_PER_TICK == 0) {
            ALP_TRY(alpi_tick(e->context, "seams", i, e->count));
        }
    }
    uint32_t sum = 0;
    for (uint32_t b = 0; b <= s->mask; b++) {
        sum += s->first[b];
        s->first[b] = sum; // the end, for now
    }
    s->first[s->mask + 1] = sum;
    for (uint32_t i = e->count; i-- > 0;) {
        s->sorted[--s->first[buckets[i]]] = make_entry(s, i);
    }
    return ALP_OK;
}

static bool is_same_place(const float *a, const float *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/// Whether b runs along all of a, from its end to its beginning, without any rounding.
static bool has_same_ends(const alp_scene *scene, const alpi_seam_edge *a, const alpi_seam_edge *b)
{
    uint32_t p[2], q[2];
    edge_corners(scene, a, p);
    edge_corners(scene, b, q);
    return is_same_place(scene->positions[p[0]], scene->positions[q[1]]) &&
           is_same_place(scene->positions[p[1]], scene->positions[q[0]]);
}

/// Whether the surface goes on between edges with the same ends: no crease.
static bool is_smooth(const alp_scene *scene, const alpi_seam_edge *a, const alpi_seam_edge *b)
{
    uint32_t p[2], q[2];
    edge_corners(scene, a, p);
    edge_corners(scene, b, q);
    bool smooth = true;
    for (int i = 0; i < 2; i++) {
        const vec3 m = vec3_load(scene->normals[p[i]]), n = vec3_load(scene->normals[q[1 - i]]);
        smooth = smooth && (double)vec3_dot(m, n) >= ALPI_SEAM_COSINE;
    }
    return smooth;
}

/// How far edges may lie apart that do not have the same ends.
static double find_tolerance(const alpi_seam_edge *a, const alpi_seam_edge *b,
                             const double3 ends[2])
{
    const double texel = fmin((double)a->texel, (double)b->texel);
    double largest = 0.0;
    for (int i = 0; i < 2; i++) {
        largest = fmax(largest, fmax(fabs(ends[i].x), fmax(fabs(ends[i].y), fabs(ends[i].z))));
    }
    return APART * texel + fmin(ROUNDING * largest, ROUNDING_LIMIT * texel);
}

/// Whether a and b meet within the tolerance, along more than a point.
static bool meet_nearly(const alp_scene *scene, const alpi_seam_edge *a, const alpi_seam_edge *b,
                        alpi_seam_pair *pair)
{
    double3 p[2], q[2];
    edge_ends(scene, a, p);
    edge_ends(scene, b, q);
    const double tolerance = find_tolerance(a, b, p);
    const double3 along = double3_sub(p[1], p[0]);
    const double length = double3_length(along);
    const double3 unit = double3_scale(along, 1.0 / length);
    const double from = double3_dot(double3_sub(q[1], p[0]), unit);
    const double to = double3_dot(double3_sub(q[0], p[0]), unit); // b runs the other way
    const double begin = fmax(from, 0.0), end = fmin(to, length);
    if (!(end - begin > 2.0 * tolerance)) {
        return false;
    }
    const double ends[2] = {begin, end};
    *pair = (alpi_seam_pair){.edges = {*a, *b}, .length = end - begin};
    for (int i = 0; i < 2; i++) {
        const double share = (to - ends[i]) / (to - from);
        const double3 on_a = double3_add(p[0], double3_scale(unit, ends[i]));
        const double3 on_b = double3_add(q[0], double3_scale(double3_sub(q[1], q[0]), share));
        if (!(double3_length(double3_sub(on_a, on_b)) <= tolerance)) {
            return false;
        }
        double *shares = i == 0 ? pair->begins : pair->ends;
        shares[0] = ends[i] / length;
        shares[1] = share;
    }
    return true;
}

/// Whether the middles of edges are no farther apart than they would be if the edges met.
static bool may_meet(const pair_search *s, const entry *a, const entry *b)
{
    double squares = 0.0, rounded = 0.0;
    for (int k = 0; k < 3; k++) {
        const double apart = (double)a->middle[k] - (double)b->middle[k];
        squares += apart * apart;
        rounded += ROUNDING * fabs((double)a->middle[k]);
    }
    const double texel = (double)s->edges->edges[a->edge].texel;
    const double reach =
        0.5 * ((double)a->length + (double)b->length) + (APART + ROUNDING_LIMIT) * texel + rounded;
    return !(squares > reach * reach * (1.0 + ROUNDING));
}

/// Whether edges meet: with the same ends, or nearly where neither of them is settled.
static bool meet(const pair_search *s, uint32_t own, uint32_t other, alpi_seam_pair *pair)
{
    const alpi_seam_edge *a = &s->edges->edges[own], *b = &s->edges->edges[other];
    if (a->half_edge / 3 == b->half_edge / 3) {
        return false;
    }
    if (has_same_ends(s->scene, a, b)) {
        *pair = (alpi_seam_pair){.edges = {*a, *b},
                                 .begins = {0.0, 1.0},
                                 .ends = {1.0, 0.0},
                                 .length = (double)a->length};
        return true;
    }
    return !s->settled[own] && !s->settled[other] && meet_nearly(s->scene, a, b, pair);
}

static alp_result keep(const pair_search *s, const alpi_seam_pair *pair, found_pairs *found)
{
    ALP_TRY(alpi_grow(s->edges->context, (void **)&found->pairs, &found->capacity, found->count + 1,
                      sizeof *pair));
    found->pairs[found->count++] = *pair;
    return ALP_OK;
}

/// Looks at the edges of one cell. @param left out: how many may still be looked at
static alp_result look_in(const pair_search *s, const entry *own, const cell *c, uint32_t *left,
                          found_pairs *found)
{
    const bool alike = octave_of(own->length) == c->octave;
    const uint32_t bucket = hash_cell(s, c);
    for (uint32_t i = s->first[bucket]; i < s->first[bucket + 1] && *left > 0; i++) {
        const entry *other = &s->sorted[i];
        if (octave_of(other->length) != c->octave || (alike && other->edge <= own->edge)) {
            continue;
        }
        --*left;
        alpi_seam_pair pair;
        if (!may_meet(s, own, other) || !meet(s, own->edge, other->edge, &pair)) {
            continue;
        }
        const cell at = cell_of(s, &s->edges->edges[other->edge]); // others may share the bucket
        if (at.x[0] == c->x[0] && at.x[1] == c->x[1] && at.x[2] == c->x[2]) {
            ALP_TRY(keep(s, &pair, found));
        }
    }
    return ALP_OK;
}

static alp_result look_around(const pair_search *s, const entry *own, int octave,
                              found_pairs *found)
{
    const alpi_seam_edge *edge = &s->edges->edges[own->edge];
    const double size = ldexp(1.0, octave);
    double3 p[2];
    edge_ends(s->scene, edge, p);
    // Half a length of the other, and what is between them.
    const double reach = 0.5 * size + (APART + ROUNDING_LIMIT) * (double)edge->texel;
    const double low[3] = {fmin(p[0].x, p[1].x), fmin(p[0].y, p[1].y), fmin(p[0].z, p[1].z)};
    const double high[3] = {fmax(p[0].x, p[1].x), fmax(p[0].y, p[1].y), fmax(p[0].z, p[1].z)};
    int64_t begin[3], end[3];
    for (int k = 0; k < 3; k++) {
        begin[k] = find_cell(low[k] - reach, size);
        end[k] = find_cell(high[k] + reach, size);
    }
    uint32_t left = LOOK_LIMIT;
    cell c = {.octave = octave};
    for (c.x[2] = begin[2]; c.x[2] <= end[2]; c.x[2]++) {
        for (c.x[1] = begin[1]; c.x[1] <= end[1]; c.x[1]++) {
            for (c.x[0] = begin[0]; c.x[0] <= end[0]; c.x[0]++) {
                ALP_TRY(look_in(s, own, &c, &left, found));
            }
        }
    }
    return ALP_OK;
}

/// Marks the edges across which the surface goes on at another with the same ends.
static alp_result settle_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const pair_search *s = user;
    const alpi_seam_edges *e = s->edges;
    for (uint32_t own = begin; own < end; own++) {
        const alpi_seam_edge *a = &e->edges[own];
        const cell c = cell_of(s, a);
        const entry at = make_entry(s, own);
        const uint32_t bucket = hash_cell(s, &c);
        uint32_t left = LOOK_LIMIT;
        for (uint32_t i = s->first[bucket]; i < s->first[bucket + 1] && left > 0; i++, left--) {
            if (!is_same_place(at.middle, s->sorted[i].middle)) {
                continue;
            }
            const alpi_seam_edge *b = &e->edges[s->sorted[i].edge];
            if (a->half_edge / 3 != b->half_edge / 3 && has_same_ends(s->scene, a, b) &&
                is_smooth(s->scene, a, b)) {
                s->settled[own] = 1;
                break;
            }
        }
    }
    return ALP_OK;
}

/// Looks for all partners of an edge.
static alp_result look_for_partners(const pair_search *s, uint32_t own, found_pairs *found)
{
    const entry at = make_entry(s, own);
    if (s->settled[own]) {
        const cell c = cell_of(s, &s->edges->edges[own]);
        uint32_t left = LOOK_LIMIT;
        return look_in(s, &at, &c, &left, found);
    }
    for (int octave = octave_of(at.length); octave <= s->highest; octave++) {
        if (s->octaves[octave + 256]) {
            ALP_TRY(look_around(s, &at, octave, found));
        }
    }
    return ALP_OK;
}

/// Some edges, part by part, each of which has a list of its own, so that the order of what is
/// found does not depend on workers.
typedef struct search_band {
    const pair_search *search;
    found_pairs found[PARTS];
} search_band;

/// Looks for the partners of some edges that are left of a part.
static alp_result search_part(const pair_search *s, found_pairs *found)
{
    while (found->next < found->end && found->count < PAIR_LIMIT) {
        ALP_TRY(look_for_partners(s, found->next++, found));
    }
    return ALP_OK;
}

static alp_result search_parts(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    search_band *band = user;
    for (uint32_t part = begin; part < end; part++) {
        ALP_TRY(search_part(band->search, &band->found[part]));
    }
    return ALP_OK;
}

/// Visits what was found, and what is found in parts that stopped.
static alp_result visit_found(search_band *band, alpi_seam_pair_fn *each, void *user)
{
    for (uint32_t part = 0; part < PARTS; part++) {
        found_pairs *found = &band->found[part];
        while (found->count > 0) {
            for (size_t i = 0; i < found->count; i++) {
                ALP_TRY(each(user, &found->pairs[i]));
            }
            found->count = 0;
            ALP_TRY(search_part(band->search, found));
        }
    }
    return ALP_OK;
}

static alp_result search_all(const pair_search *s, const alpi_task_progress *told,
                             alpi_seam_pair_fn *each, void *user)
{
    const uint32_t count = s->edges->count;
    search_band band = {.search = s};
    alpi_task_progress progress = *told;
    alp_result result = ALP_OK;
    progress.units_total = count;
    progress.units_per_item = EDGES_PER_PART;
    for (uint32_t first = 0; first < count && result == ALP_OK;) {
        progress.units_before = first;
        for (uint32_t part = 0; part < PARTS; part++) {
            const uint32_t left = count - first;
            band.found[part].next = first;
            first += left < EDGES_PER_PART ? left : EDGES_PER_PART;
            band.found[part].end = first;
        }
        result = alpi_parallel_for(s->edges->context, PARTS, 1, search_parts, &band, &progress);
        if (result == ALP_OK) {
            result = visit_found(&band, each, user);
        }
    }
    for (uint32_t part = 0; part < PARTS; part++) {
        alpi_release(s->edges->context, band.found[part].pairs);
    }
    return result;
}

alp_result alpi_seam_pairs_visit(const alp_scene *scene, const alpi_seam_edges *edges,
                                 alpi_seam_pair_fn *each, void *user)
{
    uint32_t size = 16;
    while (size < edges->count && size < 1u << 30) {
        size *= 2;
    }
    pair_search s = {.scene = scene, .edges = edges, .mask = size - 1};
    s.first = ALPI_NEW(edges->context, uint32_t, (size_t)size + 1);
    s.sorted = ALPI_NEW(edges->context, entry, edges->count);
    s.settled = ALPI_NEW(edges->context, uint8_t, edges->count);
    uint32_t *buckets = ALPI_NEW(edges->context, uint32_t, edges->count);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (s.first != NULL && s.sorted != NULL && s.settled != NULL && buckets != NULL) {
        result = sort_edges(&s, buckets);
    }
    alpi_release(edges->context, buckets);
    const alpi_watch *watch = alpi_context_watch(edges->context);
    const alpi_task_progress told = {
        .callback = watch->callback, .user = watch->user, .stage = "seams"};
    if (result == ALP_OK) {
        result = alpi_parallel_for(edges->context, edges->count, EDGES_PER_PART, settle_range, &s,
                                   &told);
    }
    result = result == ALP_OK ? search_all(&s, &told, each, user) : result;
    alpi_release(edges->context, s.first);
    alpi_release(edges->context, s.sorted);
    alpi_release(edges->context, s.settled);
    return result;
}
