// SPDX-License-Identifier: MIT
// Body of the loops over few triangles, included once for each instruction set.
//
// A ray from o along d meets a convex polygon if it passes all its edges on the same side. With
// corners relative to o, the side of the edge from p to q is the sign of d·(p×q): three products a
// ray, p×q being the same for all rays from one origin. It is found once, whatever polygons have
// that edge, so that no ray slips through between two of them. Two triangles that are a flat and
// convex quadrilateral together are met as that; which of them it was is told by the diagonal.
// Based on: T. Davidovič, T. Engelhardt, I. Georgiev, P. Slusallek, C. Dachsbacher. 3D
// Rasterization: A Bridge between Rasterization and Ray Casting. Graphics Interface 2012.
#include "trace/few.h"

#include <string.h>

// Vectors of the compiler's: left to itself, gcc makes branches of comparisons that are combined.
// One holds a part of a packet, all of it, or two packets side by side.
#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define BY_SIXTEEN
#endif
#if defined(BY_SIXTEEN)
enum { WIDTH = 16 };
typedef float half_floats __attribute__((vector_size(32)));
#elif defined(__AVX__)
enum { WIDTH = 8 };
#else
enum { WIDTH = 4 };
#endif
enum {
    TOGETHER = (int)WIDTH > (int)ALPI_PACKET ? 2 : 1,                    // packets in a vector
    PART = (int)WIDTH < (int)ALPI_PACKET ? (int)WIDTH : (int)ALPI_PACKET // lanes of each
};
typedef float floats __attribute__((vector_size(4 * WIDTH)));
typedef int32_t masks __attribute__((vector_size(4 * WIDTH))); // all ones or 0, of a comparison

/// Lanes of a packet, and of the one beside it, if any: floats, or numbers whose bits are kept.
static inline floats load(const void *lanes, const void *beside)
{
#if defined(BY_SIXTEEN)
    half_floats a, b;
    memcpy(&a, lanes, sizeof a);
    memcpy(&b, beside, sizeof b);
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#else
    floats v;
    (void)beside;
    memcpy(&v, lanes, sizeof v);
    return v;
#endif
}

/// A field of two packets, from lane `first` on.
#define LOAD(rays, field, first) load((rays)[0]->field + (first), (rays)[1]->field + (first))

static inline void keep(floats v, void *lanes, void *beside)
{
#if defined(BY_SIXTEEN)
    const half_floats a = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7);
    const half_floats b = __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
    memcpy(lanes, &a, sizeof a);
    memcpy(beside, &b, sizeof b);
#else
    (void)beside;
    memcpy(lanes, &v, sizeof v);
#endif
}

static inline masks load_masks(const uint32_t *lanes, const uint32_t *beside)
{
    return (masks)load(lanes, beside);
}

static inline floats choose(masks which, floats a, floats b)
{
    return (floats)((which & (masks)a) | (~which & (masks)b));
}

/// Bit i: lane i.
static inline uint32_t bits_of(masks which)
{
#if defined(BY_SIXTEEN)
    return (uint16_t)__builtin_ia32_cvtd2mask512(which);
#elif defined(__AVX__)
    return (uint32_t)__builtin_ia32_movmskps256((floats)which);
#else
    uint32_t bits = 0;
    for (int k = 0; k < WIDTH; k++) {
        bits |= which[k] < 0 ? 1u << k : 0u;
    }
    return bits;
#endif
}

/// Corners seen from the origins of a packet.
static inline void see_corners(const alpi_few *few, const alpi_few_list *list,
                               const alpi_rays *const rays[2], int i, floats corners[][3])
{
    const floats origin[3] = {LOAD(rays, origin_x, i), LOAD(rays, origin_y, i),
                              LOAD(rays, origin_z, i)};
    for (uint32_t c = 0; c < list->corner_count; c++) {
        const uint32_t corner = list->corners[c];
        for (int k = 0; k < 3; k++) {
            corners[corner][k] = few->corner[corner][k] - origin[k];
        }
    }
}

/// p×q of an edge: on which side of it a ray passes is the sign of its product with d.
static inline void see_edge(const alpi_few_edge *edge, floats corners[][3], floats across[3])
{
    const floats *p = corners[edge->from], *q = corners[edge->to];
    for (int k = 0; k < 3; k++) {
        const int y = (k + 1) % 3, z = (k + 2) % 3;
        across[k] = p[y] * q[z] - p[z] * q[y];
    }
}

/// n·a: n·d times the distance of a polygon's plane.
static inline floats see_plane(const alpi_few_polygon *polygon, floats corners[][3])
{
    const floats *a = corners[polygon->corner];
    return polygon->normal[0] * a[0] + polygon->normal[1] * a[1] + polygon->normal[2] * a[2];
}

/// On which side of an edge rays pass, and of the edge the other way round: positive of the sides
/// of a polygon that is met from behind. Zeros are positive, so that signs tell.
static inline void pass_edge(const floats across[3], const floats direction[3], masks sides[2])
{
    const floats side =
        across[0] * direction[0] + across[1] * direction[1] + across[2] * direction[2];
    sides[0] = (masks)(side + 0.0f);
    sides[1] = (masks)(0.0f - side);
}

/// What rays do with a polygon.
typedef struct met_polygon {
    floats height, reached; // the former over the latter: the distance
    masks met, behind;
} met_polygon;

static inline void meet(const alpi_few_polygon *p, floats height, const masks *sides,
                        const floats direction[3], floats minimum, floats maximum, bool one_sided,
                        met_polygon *m)
{
    // Signs are set where some side says that the ray does not come from behind, from the front.
    masks not_behind = {0}, not_front = {0};
    for (int k = 0; k < 4; k++) {
        const uint32_t side = p->sides[k];
        not_behind |= sides[side];
        not_front |= sides[side ^ 1];
    }
    const masks passed_by = not_behind & not_front;
    const float *n = p->normal;
    const floats along = n[0] * direction[0] + n[1] * direction[1] + n[2] * direction[2];
    m->reached = (floats)((masks)along & INT32_MAX);
    // The sides' signs, not that of n·d, which rounding may take for the other.
    m->height = (floats)((masks)height ^ (not_behind & INT32_MIN));
    m->behind = not_behind >= 0;
    m->met = (passed_by >= 0) & (m->height >= m->reached * minimum) &
             (m->height < m->reached * maximum); // never of a ray within the plane: 0 < 0
    if (one_sided && p->single_sided) {
        m->met &= ~m->behind;
    }
}

static bool share_origins(const alpi_rays *a, const alpi_rays *b)
{
    bool same = true;
    for (int i = 0; i < ALPI_PACKET; i++) {
        same &= a->origin_x[i] == b->origin_x[i] && a->origin_y[i] == b->origin_y[i] &&
                a->origin_z[i] == b->origin_z[i];
    }
    return same;
}

static uint32_t list_members(const alpi_few_set *set, uint16_t *list)
{
    uint32_t count = 0;
    for (uint32_t w = 0; w < sizeof set->words / sizeof *set->words; w++) {
        for (uint64_t left = set->words[w]; left != 0; left &= left - 1) {
            list[count++] = (uint16_t)(64 * w + (uint32_t)__builtin_ctzll(left));
        }
    }
    return count;
}

/// What rays from some box reach.
typedef struct reached_box {
    float low[3], high[3];
} reached_box;

/// Which polygons are listed changes no answer, but for rays that graze one at the end of their
/// reach: what is left out, no other ray meets.
static void list_near(const alpi_few *few, const reached_box *box, alpi_few_list *list)
{
    const float *low = box->low, *high = box->high;
    alpi_few_set edges = {{0}}, corners = {{0}};
    uint32_t near[ALPI_FEW_LIMIT] = {0};
    const uint32_t boxes = few->polygon_count + (0u - few->polygon_count) % ALPI_PACKET;
    for (uint32_t p = 0; p < boxes; p++) { // whole vectors of them: empty ones beyond the last
        near[p] = (few->low[0][p] <= high[0] ? 1u : 0u) & (few->high[0][p] >= low[0] ? 1u : 0u) &
                  (few->low[1][p] <= high[1] ? 1u : 0u) & (few->high[1][p] >= low[1] ? 1u : 0u) &
                  (few->low[2][p] <= high[2] ? 1u : 0u) & (few->high[2][p] >= low[2] ? 1u : 0u);
    }
    list->polygon_count = 0;
    for (uint32_t p = 0; p < few->polygon_count; p++) {
        list->polygons[list->polygon_count] = (uint16_t)p;
        list->polygon_count += near[p];
    }
    for (uint32_t k = 0; k < list->polygon_count; k++) {
        const alpi_few_polygon *polygon = &few->polygon[list->polygons[k]];
        for (uint32_t w = 0; w < sizeof edges.words / sizeof *edges.words; w++) {
            edges.words[w] |= polygon->edges.words[w];
            corners.words[w] |= polygon->corners.words[w];
        }
    }
    list->edge_count = list_members(&edges, list->edges);
    list->corner_count = list_members(&corners, list->corners);
}

/// How far any ray of the lanes that count goes.
static float farthest(const alpi_rays *packets, uint32_t count, const uint32_t lanes[ALPI_PACKET])
{
    floats far = {0};
    float reach = 0.0f;
    for (const alpi_rays *rays = packets; rays < packets + count; rays++) {
        for (int i = 0; i < ALPI_PACKET; i += PART) {
            const floats maximum = load(rays->maximum + i, rays->maximum + i);
            const masks active = load_masks(lanes + i, lanes + i);
            far = choose(active & (maximum > far), maximum, far);
        }
    }
    for (int i = 0; i < WIDTH; i++) {
        reach = far[i] > reach ? far[i] : reach;
    }
    return reach;
}

/// Whether some ray may reach across everything.
static bool reaches_all(const alpi_few *few, float reach)
{
    return !(reach < few->extent);
}

/// @param lanes that count: all ones for these, 0 for the others
/// @param room  for a list @return it, or that of all
static const alpi_few_list *list_reached(const alpi_few *few, const alpi_rays *packets,
                                         uint32_t count, const uint32_t lanes[ALPI_PACKET],
                                         alpi_few_list *room)
{
    const floats none = (floats){0} + INFINITY;
    floats low[3] = {none, none, none}, high[3] = {-none, -none, -none};
    const float reach = farthest(packets, count, lanes);
    if (reaches_all(few, reach)) {
        return &few->all;
    }
    for (uint32_t p = 0; p < count; p++) {
        const alpi_rays *const rays[2] = {&packets[p], &packets[p]};
        for (int i = 0; i < ALPI_PACKET; i += PART) {
            const masks active = load_masks(lanes + i, lanes + i);
            const floats at[3] = {LOAD(rays, origin_x, i), LOAD(rays, origin_y, i),
                                  LOAD(rays, origin_z, i)};
            for (int k = 0; k < 3; k++) {
                low[k] = choose(active & (at[k] < low[k]), at[k], low[k]);
                high[k] = choose(active & (at[k] > high[k]), at[k], high[k]);
            }
        }
    }
    reached_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = 0; i < WIDTH; i++) {
        for (int k = 0; k < 3; k++) {
            box.low[k] = low[k][i] < box.low[k] ? low[k][i] : box.low[k];
            box.high[k] = high[k][i] > box.high[k] ? high[k][i] : box.high[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        box.low[k] -= reach + few->slack;
        box.high[k] += reach + few->slack;
    }
    list_near(few, &box, room);
    return room;
}

static inline void load_direction(const alpi_rays *const rays[2], int i, floats direction[3])
{
    direction[0] = LOAD(rays, direction_x, i);
    direction[1] = LOAD(rays, direction_y, i);
    direction[2] = LOAD(rays, direction_z, i);
}

/// What is the same for all rays from the origins of a vector of lanes.
typedef struct seen_list {
    floats corners[ALPI_FEW_EDGES][3]; // by corner
    floats across[ALPI_FEW_EDGES][3];  // by place in the list, see_edge
    floats heights[ALPI_FEW_LIMIT];    // by place in the list, see_plane
} seen_list;

static inline void see_list(const alpi_few *few, const alpi_few_list *list,
                            const alpi_rays *const rays[2], int i, seen_list *seen)
{
    see_corners(few, list, rays, i, seen->corners);
    for (uint32_t e = 0; e < list->edge_count; e++) {
        see_edge(&few->edge[list->edges[e]], seen->corners, seen->across[e]);
    }
    for (uint32_t k = 0; k < list->polygon_count; k++) {
        seen->heights[k] = see_plane(&few->polygon[list->polygons[k]], seen->corners);
    }
}

/// On which sides of the listed edges rays pass. @param sides out: by edge, see pass_edge
static inline void pass_edges(const alpi_few_list *list, const seen_list *seen,
                              const floats direction[3], masks *sides)
{
    for (uint32_t e = 0; e < list->edge_count; e++) {
        pass_edge(seen->across[e], direction, &sides[2 * (size_t)list->edges[e]]);
    }
}

/// Packets that share their origins.
static void stop_rays(const alpi_few *few, const alpi_few_list *list, alpi_rays *packets,
                      uint32_t count, const uint32_t lanes[ALPI_PACKET], bool one_sided)
{
    seen_list seen;
    masks sides[2 * ALPI_FEW_EDGES];
    for (int i = 0; i < ALPI_PACKET; i += PART) {
        const masks active = load_masks(lanes + i, lanes + i);
        see_list(few, list, (const alpi_rays *const[2]){packets, packets}, i, &seen);
        for (uint32_t p = 0; p < count; p += TOGETHER) {
            alpi_rays *const to[2] = {&packets[p], &packets[p + 1 < count ? p + 1 : p]};
            const alpi_rays *const rays[2] = {to[0], to[1]};
            const floats minimum = LOAD(rays, minimum, i), maximum = LOAD(rays, maximum, i);
            masks stopped = {0};
            floats direction[3];
            load_direction(rays, i, direction);
            pass_edges(list, &seen, direction, sides);
            for (uint32_t k = 0; k < list->polygon_count; k++) {
                met_polygon m;
                meet(&few->polygon[list->polygons[k]], seen.heights[k], sides, direction, minimum,
                     maximum, one_sided, &m);
                stopped |= m.met;
            }
            const floats left = choose(stopped & active, (floats){0} - INFINITY, maximum);
            keep(left, to[0]->maximum + i, to[1]->maximum + i);
        }
    }
}

static void occluded(const alpi_few *few, alpi_rays *packets, uint32_t count,
                     const uint32_t lanes[ALPI_PACKET], bool one_sided)
{
    alpi_few_list room;
    const alpi_few_list *list = list_reached(few, packets, count, lanes, &room);
    for (uint32_t first = 0, end = 0; first < count; first = end) {
        for (end = first + 1; end < count && share_origins(&packets[first], &packets[end]);) {
            end++;
        }
        stop_rays(few, list, packets + first, end - first, lanes, one_sided);
    }
}

/// The nearest polygons of a packet so far.
typedef struct nearest_hits {
    floats distance;
    masks polygon, behind;           // polygon: -1 where there is none
    masks sides[2 * ALPI_FEW_EDGES]; // see pass_edge
} nearest_hits;

/// A vector of lanes, from `first` on, of a packet or of two, and what they see. A packet alone is
/// there twice.
typedef struct packet_view {
    const alpi_few *few;
    const alpi_few_list *list;
    seen_list *seen;
    const alpi_rays *const *rays; // [2]
    int first;
} packet_view;

static inline void find_nearest(const packet_view *view, bool one_sided, nearest_hits *hits)
{
    const alpi_few *few = view->few;
    const alpi_few_list *list = view->list;
    const seen_list *seen = view->seen;
    const alpi_rays *const *rays = view->rays;
    const int i = view->first;
    floats direction[3];
    const floats minimum = LOAD(rays, minimum, i);
    hits->distance = LOAD(rays, maximum, i);
    hits->polygon = (masks){0} - 1;
    hits->behind = (masks){0};
    load_direction(rays, i, direction);
    pass_edges(list, seen, direction, hits->sides);
    for (uint32_t k = 0; k < list->polygon_count; k++) {
        met_polygon m;
        meet(&few->polygon[list->polygons[k]], seen->heights[k], hits->sides, direction, minimum,
             hits->distance, one_sided, &m);
        if (bits_of(m.met) == 0) {
            continue; // of eight rays that part two in three times
        }
        hits->distance = choose(m.met, m.height / m.reached, hits->distance);
        hits->behind = (m.met & m.behind) | (~m.met & hits->behind);
        hits->polygon = (m.met & (int32_t)list->polygons[k]) | (~m.met & hits->polygon);
    }
}

/// Which triangle of a polygon rays met, and where: a corner weighs as much as the ray is beside
/// the edge across from it. By the distance it might lie beyond an edge, of rays that graze.
typedef struct met_triangle {
    masks triangle;
    floats b1, b2;
} met_triangle;

static inline void find_triangle(const alpi_few_polygon *polygon, seen_list *seen,
                                 const floats direction[3], const nearest_hits *found,
                                 met_triangle *met)
{
    const floats none = {0};
    const floats turn = choose(found->behind, none + 1.0f, none - 1.0f);
    floats across[3], beside[5], weights[3];
    see_edge(&polygon->diagonal, seen->corners, across);
    const floats diagonal =
        turn * (across[0] * direction[0] + across[1] * direction[1] + across[2] * direction[2]);
    const masks second = diagonal < 0.0f;
    for (int s = 0; s < 4; s++) {
        beside[s] = turn * (floats)found->sides[polygon->sides[s]];
    }
    beside[4] = choose(second, none - diagonal, diagonal);
    for (int k = 0; k < 3; k++) {
        weights[k] = choose(second, beside[polygon->weights[1][k]], beside[polygon->weights[0][k]]);
    }
    const floats whole = weights[0] + weights[1] + weights[2];
    const floats scale = choose(whole > 0.0f, 1.0f / whole, none);
    met->triangle =
        (second & (int32_t)polygon->triangles[1]) | (~second & (int32_t)polygon->triangles[0]);
    met->b1 = weights[1] * scale;
    met->b2 = weights[2] * scale;
}

/// The lanes of `which` of some numbers, the others as they are.
static inline void store(masks which, floats numbers, void *lanes, void *beside)
{
    keep(choose(which, numbers, load(lanes, beside)), lanes, beside);
}

/// Writes down what the lanes that take part met: polygon by polygon, of which a packet meets two
/// or three.
static inline void take_hits(const packet_view *view, const nearest_hits *found, masks active,
                             alpi_hits *const hits[2])
{
    floats direction[3];
    const masks hit = active & (found->polygon != -1);
    met_triangle all = {.triangle = (masks){0} - 1};
    load_direction(view->rays, view->first, direction);
    for (uint32_t left = bits_of(hit); left != 0;) {
        const int32_t polygon = found->polygon[__builtin_ctz(left)];
        const masks which = hit & (found->polygon == polygon);
        met_triangle met;
        find_triangle(&view->few->polygon[polygon], view->seen, direction, found, &met);
        all.triangle = (which & met.triangle) | (~which & all.triangle);
        all.b1 = choose(which, met.b1, all.b1);
        all.b2 = choose(which, met.b2, all.b2);
        left &= ~bits_of(which);
    }
    const floats distance = choose(hit, found->distance, (floats){0} + INFINITY);
    const int i = view->first;
    store(active, distance, hits[0]->distance + i, hits[1]->distance + i);
    store(active, (floats)all.triangle, hits[0]->triangle + i, hits[1]->triangle + i);
    store(active, all.b1, hits[0]->b1 + i, hits[1]->b1 + i);
    store(active, all.b2, hits[0]->b2 + i, hits[1]->b2 + i);
    const uint32_t behind = bits_of(hit & found->behind);
    hits[0]->behind |= (behind & ((1u << PART) - 1u)) << i;
    hits[1]->behind |= TOGETHER > 1 ? behind >> PART : 0;
}

static void spread_bits(uint32_t bits, uint32_t lanes[ALPI_PACKET])
{
    for (int lane = 0; lane < ALPI_PACKET; lane++) {
        lanes[lane] = 0u - (bits >> lane & 1u);
    }
}

/// Packets that were met last.
typedef struct packets_before {
    bool reach_all;
    const alpi_rays *rays[2];
} packets_before;

/// Whether packets see what those before them saw: they share their origins, and all reach
/// everything.
static bool see_the_same(const packets_before *before, const packets_before *now)
{
    return before->reach_all && now->reach_all && share_origins(before->rays[0], now->rays[0]) &&
           (TOGETHER == 1 || share_origins(before->rays[1], now->rays[1]));
}

/// Two packets go side by side where both reach everything: what one may reach is not the other's.
static void nearest(const alpi_few *few, const alpi_rays *const *packets, const uint32_t *active,
                    uint32_t count, bool one_sided, alpi_hits *hits)
{
    seen_list seen[ALPI_PACKET / PART];
    packets_before before = {0};
    for (uint32_t p = 0, q; p < count; p = q + 1) {
        alpi_few_list room;
        uint32_t lanes[2][ALPI_PACKET];
        spread_bits(active[p], lanes[0]);
        const alpi_few_list *list = list_reached(few, packets[p], 1, lanes[0], &room);
        q = p;
        if (TOGETHER > 1 && p + 1 < count && list == &few->all) {
            spread_bits(active[p + 1], lanes[1]);
            q += reaches_all(few, farthest(packets[p + 1], 1, lanes[1])) ? 1 : 0;
        }
        const packets_before now = {list == &few->all, {packets[p], packets[q]}};
        const bool again = see_the_same(&before, &now);
        before = now;
        hits[p].behind &= ~active[p];
        hits[q].behind &= ~active[q];
        for (int i = 0; i < ALPI_PACKET; i += PART) {
            const packet_view view = {few, list, &seen[i / PART], now.rays, i};
            nearest_hits found;
            if (!again) {
                see_list(few, list, now.rays, i, view.seen);
            }
            find_nearest(&view, one_sided, &found);
            take_hits(&view, &found, load_masks(lanes[0] + i, lanes[q - p] + i),
                      (alpi_hits *const[2]){&hits[p], &hits[q]});
        }
    }
}

const alpi_few_loops ALPI_VARIANT(alpi_few_loops) = {occluded, nearest};
