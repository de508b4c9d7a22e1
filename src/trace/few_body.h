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
#ifdef __AVX__
enum { WIDTH = 8 };
#else
enum { WIDTH = 4 };
#endif
typedef float floats __attribute__((vector_size(4 * WIDTH)));
typedef int32_t masks __attribute__((vector_size(4 * WIDTH))); // all ones or 0, of a comparison

static inline floats load(const float *lanes)
{
    floats v;
    memcpy(&v, lanes, sizeof v);
    return v;
}

static inline masks load_masks(const uint32_t *lanes)
{
    masks v;
    memcpy(&v, lanes, sizeof v);
    return v;
}

static inline floats choose(masks which, floats a, floats b)
{
    return (floats)((which & (masks)a) | (~which & (masks)b));
}

static inline bool is_none(masks which)
{
#ifdef __AVX__
    return __builtin_ia32_movmskps256((floats)which) == 0;
#else
    uint64_t words[sizeof which / sizeof(uint64_t)], any = 0;
    memcpy(words, &which, sizeof which);
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        any |= words[k];
    }
    return any == 0;
#endif
}

/// Corners seen from the origins of a packet.
static inline void see_corners(const alpi_few *few, const alpi_few_list *list,
                               const alpi_rays *rays, int i, floats corners[][3])
{
    const floats origin[3] = {load(rays->origin_x + i), load(rays->origin_y + i),
                              load(rays->origin_z + i)};
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

/// @param lanes that count: all ones for these, 0 for the others
/// @param room  for a list @return it, or that of all
static const alpi_few_list *list_reached(const alpi_few *few, const alpi_rays *packets,
                                         uint32_t count, const uint32_t lanes[ALPI_PACKET],
                                         alpi_few_list *room)
{
    const floats none = (floats){0} + INFINITY;
    floats low[3] = {none, none, none}, high[3] = {-none, -none, -none}, far = {0};
    for (const alpi_rays *rays = packets; rays < packets + count; rays++) {
        for (int i = 0; i < ALPI_PACKET; i += WIDTH) {
            const masks active = load_masks(lanes + i);
            const floats at[3] = {load(rays->origin_x + i), load(rays->origin_y + i),
                                  load(rays->origin_z + i)};
            const floats reach = load(rays->maximum + i);
            far = choose(active & (reach > far), reach, far);
            for (int k = 0; k < 3; k++) {
                low[k] = choose(active & (at[k] < low[k]), at[k], low[k]);
                high[k] = choose(active & (at[k] > high[k]), at[k], high[k]);
            }
        }
    }
    reached_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    float reach = 0.0f;
    for (int i = 0; i < WIDTH; i++) {
        reach = far[i] > reach ? far[i] : reach;
        for (int k = 0; k < 3; k++) {
            box.low[k] = low[k][i] < box.low[k] ? low[k][i] : box.low[k];
            box.high[k] = high[k][i] > box.high[k] ? high[k][i] : box.high[k];
        }
    }
    if (!(reach < few->extent)) {
        return &few->all;
    }
    for (int k = 0; k < 3; k++) {
        box.low[k] -= reach + few->slack;
        box.high[k] += reach + few->slack;
    }
    list_near(few, &box, room);
    return room;
}

static inline void load_direction(const alpi_rays *rays, int i, floats direction[3])
{
    direction[0] = load(rays->direction_x + i);
    direction[1] = load(rays->direction_y + i);
    direction[2] = load(rays->direction_z + i);
}

/// Packets that share their origins.
static void stop_rays(const alpi_few *few, const alpi_few_list *list, alpi_rays *packets,
                      uint32_t count, const uint32_t lanes[ALPI_PACKET], bool one_sided)
{
    floats corners[ALPI_FEW_EDGES][3], across[ALPI_FEW_EDGES][3], heights[ALPI_FEW_LIMIT];
    masks sides[2 * ALPI_FEW_EDGES];
    for (int i = 0; i < ALPI_PACKET; i += WIDTH) {
        const masks active = load_masks(lanes + i);
        see_corners(few, list, packets, i, corners);
        for (uint32_t e = 0; e < list->edge_count; e++) {
            see_edge(&few->edge[list->edges[e]], corners, across[e]);
        }
        for (uint32_t k = 0; k < list->polygon_count; k++) {
            heights[k] = see_plane(&few->polygon[list->polygons[k]], corners);
        }
        for (alpi_rays *rays = packets; rays < packets + count; rays++) {
            const floats minimum = load(rays->minimum + i), maximum = load(rays->maximum + i);
            masks stopped = {0};
            floats direction[3];
            load_direction(rays, i, direction);
            for (uint32_t e = 0; e < list->edge_count; e++) {
                pass_edge(across[e], direction, &sides[2 * (size_t)list->edges[e]]);
            }
            for (uint32_t k = 0; k < list->polygon_count; k++) {
                met_polygon m;
                meet(&few->polygon[list->polygons[k]], heights[k], sides, direction, minimum,
                     maximum, one_sided, &m);
                stopped |= m.met;
            }
            const floats left = choose(stopped & active, (floats){0} - INFINITY, maximum);
            memcpy(rays->maximum + i, &left, sizeof left);
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

static inline void find_nearest(const alpi_few *few, const alpi_few_list *list,
                                const alpi_rays *rays, int i, bool one_sided, nearest_hits *hits)
{
    floats corners[ALPI_FEW_EDGES][3], direction[3];
    const floats minimum = load(rays->minimum + i);
    hits->distance = load(rays->maximum + i);
    hits->polygon = (masks){0} - 1;
    hits->behind = (masks){0};
    load_direction(rays, i, direction);
    see_corners(few, list, rays, i, corners);
    for (uint32_t e = 0; e < list->edge_count; e++) {
        floats across[3];
        see_edge(&few->edge[list->edges[e]], corners, across);
        pass_edge(across, direction, &hits->sides[2 * (size_t)list->edges[e]]);
    }
    for (uint32_t k = 0; k < list->polygon_count; k++) {
        const alpi_few_polygon *polygon = &few->polygon[list->polygons[k]];
        met_polygon m;
        meet(polygon, see_plane(polygon, corners), hits->sides, direction, minimum, hits->distance,
             one_sided, &m);
        if (is_none(m.met)) {
            continue; // of eight rays that part two in three times
        }
        hits->distance = choose(m.met, m.height / m.reached, hits->distance);
        hits->behind = (m.met & m.behind) | (~m.met & hits->behind);
        hits->polygon = (m.met & (int32_t)list->polygons[k]) | (~m.met & hits->polygon);
    }
}

/// d·(p×q) of a diagonal, for one ray.
static inline float pass_diagonal(const alpi_few *few, const alpi_few_edge *edge,
                                  const alpi_rays *rays, int lane)
{
    const float *from = few->corner[edge->from], *to = few->corner[edge->to];
    const float px = from[0] - rays->origin_x[lane], qx = to[0] - rays->origin_x[lane];
    const float py = from[1] - rays->origin_y[lane], qy = to[1] - rays->origin_y[lane];
    const float pz = from[2] - rays->origin_z[lane], qz = to[2] - rays->origin_z[lane];
    return (py * qz - pz * qy) * rays->direction_x[lane] +
           (pz * qx - px * qz) * rays->direction_y[lane] +
           (px * qy - py * qx) * rays->direction_z[lane];
}

/// Which triangle of a polygon a ray met, and where: a corner weighs as much as the ray is beside
/// the edge across from it. By the distance it might lie beyond an edge, of rays that graze.
static inline void find_triangle(const alpi_few *few, const nearest_hits *found, int k,
                                 const alpi_rays *rays, int lane, alpi_hits *hits)
{
    const alpi_few_polygon *polygon = &few->polygon[found->polygon[k]];
    const float turn = found->behind[k] != 0 ? 1.0f : -1.0f;
    const float diagonal = turn * pass_diagonal(few, &polygon->diagonal, rays, lane);
    const int which = diagonal < 0.0f ? 1 : 0;
    float beside[5];
    for (int s = 0; s < 4; s++) {
        beside[s] = turn * ((floats)found->sides[polygon->sides[s]])[k];
    }
    beside[4] = which == 0 ? diagonal : -diagonal;
    const uint8_t *weights = polygon->weights[which];
    const float a = beside[weights[0]], b = beside[weights[1]], c = beside[weights[2]];
    const float whole = a + b + c, scale = whole > 0.0f ? 1.0f / whole : 0.0f;
    hits->triangle[lane] = polygon->triangles[which];
    hits->b1[lane] = b * scale;
    hits->b2[lane] = c * scale;
}

static void nearest(const alpi_few *few, const alpi_rays *rays, uint32_t active, bool one_sided,
                    alpi_hits *hits)
{
    alpi_few_list room;
    uint32_t lanes[ALPI_PACKET];
    for (int lane = 0; lane < ALPI_PACKET; lane++) {
        lanes[lane] = 0u - (active >> lane & 1u);
    }
    const alpi_few_list *list = list_reached(few, rays, 1, lanes, &room);
    hits->behind &= ~active;
    for (int i = 0; i < ALPI_PACKET; i += WIDTH) {
        nearest_hits found;
        find_nearest(few, list, rays, i, one_sided, &found);
        for (int k = 0; k < WIDTH; k++) {
            const int lane = i + k;
            if ((active >> lane & 1u) == 0) {
                continue;
            }
            hits->distance[lane] = INFINITY;
            hits->triangle[lane] = ALPI_NONE;
            hits->b1[lane] = hits->b2[lane] = 0.0f;
            if (found.polygon[k] != -1) {
                hits->distance[lane] = found.distance[k];
                hits->behind |= found.behind[k] != 0 ? 1u << lane : 0u;
                find_triangle(few, &found, k, rays, lane, hits);
            }
        }
    }
}

const alpi_few_loops ALPI_FEW_LOOPS = {occluded, nearest};
