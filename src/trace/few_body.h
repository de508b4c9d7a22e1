// SPDX-License-Identifier: MIT
// Body of the loops over few triangles, included once for each instruction set.
//
// A ray from o along d meets the triangle abc if it passes its three edges on the same side. With
// corners relative to o, the side of the edge from p to q is the sign of d·(p×q): three products a
// ray, p×q being the same for all rays from one origin, and exactly the opposite for the triangle
// on the other side of the edge, so that no ray slips through between the two.
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

/// On which side of an edge rays pass, and of the edge the other way round: positive where it runs
/// counter-clockwise as seen from behind. Zeros are positive, so that signs tell.
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
    // Signs are set where a ray does not meet it from behind, from before. They are also those of
    // n·d then, which rounding might take for the other.
    masks before = {0}, behind = {0};
    for (int s = 0; s < 4; s++) {
        const uint32_t side = p->sides[s];
        before |= sides[side];
        behind |= sides[side ^ 1];
    }
    const masks passed = before & behind;
    const float *n = p->normal;
    const floats along = n[0] * direction[0] + n[1] * direction[1] + n[2] * direction[2];
    m->reached = (floats)((masks)along & INT32_MAX);
    m->height = (floats)((masks)height ^ (before & INT32_MIN));
    m->behind = before >= 0;
    m->met = (passed >= 0) & (m->height >= m->reached * minimum) &
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

/// What rays from some box reach. Which polygons are listed changes no answer: what is left out, no
/// ray meets.
typedef struct reached_box {
    float low[3], high[3];
} reached_box;

static void list_near(const alpi_few *few, const reached_box *box, alpi_few_list *list)
{
    const float *low = box->low, *high = box->high;
    alpi_few_set edges = {{0}}, corners = {{0}};
    uint32_t near[ALPI_FEW_LIMIT];
    const uint32_t boxes = few->polygon_count + (0u - few->polygon_count) % ALPI_PACKET;
    for (uint32_t t = 0; t < boxes; t++) { // whole vectors of them: empty ones beyond the last
        near[t] = (few->low[0][t] <= high[0] ? 1u : 0u) & (few->high[0][t] >= low[0] ? 1u : 0u) &
                  (few->low[1][t] <= high[1] ? 1u : 0u) & (few->high[1][t] >= low[1] ? 1u : 0u) &
                  (few->low[2][t] <= high[2] ? 1u : 0u) & (few->high[2][t] >= low[2] ? 1u : 0u);
    }
    list->polygon_count = 0;
    for (uint32_t t = 0; t < few->polygon_count; t++) {
        list->polygons[list->polygon_count] = (uint16_t)t;
        list->polygon_count += near[t];
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
        for (uint32_t t = 0; t < list->polygon_count; t++) {
            heights[t] = see_plane(&few->polygon[list->polygons[t]], corners);
        }
        for (alpi_rays *rays = packets; rays < packets + count; rays++) {
            const floats minimum = load(rays->minimum + i), maximum = load(rays->maximum + i);
            masks stopped = {0};
            floats direction[3];
            load_direction(rays, i, direction);
            for (uint32_t e = 0; e < list->edge_count; e++) {
                pass_edge(across[e], direction, &sides[2 * (size_t)list->edges[e]]);
            }
            for (uint32_t t = 0; t < list->polygon_count; t++) {
                met_polygon m;
                meet(&few->polygon[list->polygons[t]], heights[t], sides, direction, minimum,
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
    masks polygon, behind; // polygon: -1 where there is none
} nearest_hits;

static inline void find_nearest(const alpi_few *few, const alpi_few_list *list,
                                const alpi_rays *rays, int i, bool one_sided, nearest_hits *hits)
{
    floats corners[ALPI_FEW_EDGES][3], direction[3];
    masks sides[2 * ALPI_FEW_EDGES];
    const floats minimum = load(rays->minimum + i);
    hits->distance = load(rays->maximum + i);
    hits->polygon = (masks){0} - 1;
    hits->behind = (masks){0};
    load_direction(rays, i, direction);
    see_corners(few, list, rays, i, corners);
    for (uint32_t e = 0; e < list->edge_count; e++) {
        floats across[3];
        see_edge(&few->edge[list->edges[e]], corners, across);
        pass_edge(across, direction, &sides[2 * (size_t)list->edges[e]]);
    }
    for (uint32_t t = 0; t < list->polygon_count; t++) {
        const alpi_few_polygon *polygon = &few->polygon[list->polygons[t]];
        met_polygon m;
        meet(polygon, see_plane(polygon, corners), sides, direction, minimum, hits->distance,
             one_sided, &m);
        if (is_none(m.met)) {
            continue; // of eight rays that part two in three times
        }
        hits->distance = choose(m.met, m.height / m.reached, hits->distance);
        hits->behind = (m.met & m.behind) | (~m.met & hits->behind);
        hits->polygon = (m.met & (int32_t)list->polygons[t]) | (~m.met & hits->polygon);
    }
}

/// (p − from) · along
static inline float measure(const float p[3], const float from[3], const float along[3])
{
    return (p[0] - from[0]) * along[0] + (p[1] - from[1]) * along[1] + (p[2] - from[2]) * along[2];
}

/// Which triangle of a polygon a ray meets at a distance, and where.
static inline void find_triangle(const alpi_few *few, const alpi_few_polygon *polygon,
                                 const alpi_rays *rays, int lane, alpi_hits *hits)
{
    const float far = hits->distance[lane];
    const float at[3] = {rays->origin_x[lane] + far * rays->direction_x[lane],
                         rays->origin_y[lane] + far * rays->direction_y[lane],
                         rays->origin_z[lane] + far * rays->direction_z[lane]};
    const int which = measure(at, polygon->middle, polygon->to_first) < 0.0f ? 1 : 0;
    const alpi_few_triangle *t = &few->triangle[polygon->triangles[which]];
    const float b1 = measure(at, t->corner, t->to_b1), b2 = measure(at, t->corner, t->to_b2);
    hits->triangle[lane] = t->triangle; // what passes the edges is inside it but for rounding
    hits->b1[lane] = b1 < 0.0f ? 0.0f : b1;
    hits->b2[lane] = b2 < 0.0f ? 0.0f : b2;
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
            if (found.polygon[k] != -1) {
                hits->distance[lane] = found.distance[k];
                hits->behind |= found.behind[k] != 0 ? 1u << lane : 0u;
                find_triangle(few, &few->polygon[found.polygon[k]], rays, lane, hits);
            }
        }
    }
}

const alpi_few_loops ALPI_FEW_LOOPS = {occluded, nearest};
