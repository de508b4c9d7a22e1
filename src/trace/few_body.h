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
    uint64_t words[sizeof which / sizeof(uint64_t)], any = 0;
    memcpy(words, &which, sizeof which);
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        any |= words[k];
    }
    return any == 0;
}

/// One triangle seen from the origins of a packet.
typedef struct seen_triangle {
    floats side[3][3];   // b×c, c×a, a×b: [edge][axis]
    floats height;       // n·a
    const float *normal; // n
    masks from_behind;   // all ones: rays meet it from behind too
} seen_triangle;

static inline void see(const alpi_few *few, uint32_t t, const alpi_rays *rays, int i,
                       bool one_sided, seen_triangle *seen)
{
    const floats origin[3] = {load(rays->origin_x + i), load(rays->origin_y + i),
                              load(rays->origin_z + i)};
    floats corner[3][3];
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 3; k++) {
            corner[c][k] = few->corner[t][c][k] - origin[k];
        }
    }
    for (int e = 0; e < 3; e++) {
        const floats *from = corner[(e + 1) % 3], *to = corner[(e + 2) % 3];
        for (int k = 0; k < 3; k++) {
            const int y = (k + 1) % 3, z = (k + 2) % 3;
            seen->side[e][k] = from[y] * to[z] - from[z] * to[y];
        }
    }
    const float *n = few->normal[t];
    seen->height = n[0] * corner[0][0] + n[1] * corner[0][1] + n[2] * corner[0][2];
    seen->normal = n;
    seen->from_behind = (masks){0} - (one_sided && few->single_sided[t] ? 0 : 1);
}

/// What rays along d do with the triangle: where they pass its edges, at what distance its plane.
typedef struct met_triangle {
    floats u, v, w; // over u + v + w: the weights of corners a, b, c
    floats along;   // n·d: positive from behind
    floats reached; // |n·d|: times the distance is `height`
    floats height;
    masks met;
} met_triangle;

static inline void meet(const seen_triangle *seen, const alpi_rays *rays, int i, floats maximum,
                        met_triangle *m)
{
    const floats x = load(rays->direction_x + i), y = load(rays->direction_y + i),
                 z = load(rays->direction_z + i);
    const floats *side = seen->side[0];
    m->u = side[0] * x + side[1] * y + side[2] * z;
    m->v = side[3] * x + side[4] * y + side[5] * z;
    m->w = side[6] * x + side[7] * y + side[8] * z;
    m->along = seen->normal[0] * x + seen->normal[1] * y + seen->normal[2] * z;
    // Signs, to see every ray as from behind: of n·d, as the sum of the sides, which no two of them
    // can contradict.
    const masks turn = (masks)(m->u + m->v + m->w) & INT32_MIN;
    m->reached = (floats)((masks)m->along & INT32_MAX);
    m->height = (floats)((masks)seen->height ^ turn);
    m->met = ((floats)((masks)m->u ^ turn) >= 0.0f) & ((floats)((masks)m->v ^ turn) >= 0.0f) &
             ((floats)((masks)m->w ^ turn) >= 0.0f) &
             (m->height >= m->reached * load(rays->minimum + i)) &
             (m->height < m->reached * maximum) & // never of a ray within the plane: 0 < 0
             (seen->from_behind | (m->along < 0.0f));
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

/// Triangles whose boxes rays from these origins can reach. Which of them are listed changes no
/// answer: what is left out, no ray meets.
static uint32_t list_near(const alpi_few *few, const alpi_rays *rays, float reach,
                          uint32_t list[ALPI_FEW_LIMIT])
{
    const float *const origin[3] = {rays->origin_x, rays->origin_y, rays->origin_z};
    uint32_t near[ALPI_FEW_LIMIT];
    float low[3], high[3];
    if (!(reach < few->extent)) {
        for (uint32_t t = 0; t < few->count; t++) {
            list[t] = t;
        }
        return few->count;
    }
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
        for (int i = 0; i < ALPI_PACKET; i++) {
            const float at = origin[k][i];
            low[k] = at < low[k] ? at : low[k];
            high[k] = at > high[k] ? at : high[k];
        }
        low[k] -= reach + few->slack;
        high[k] += reach + few->slack;
    }
    for (uint32_t t = 0; t < ALPI_FEW_LIMIT; t++) {
        near[t] = (few->low[0][t] <= high[0] ? 1u : 0u) & (few->high[0][t] >= low[0] ? 1u : 0u) &
                  (few->low[1][t] <= high[1] ? 1u : 0u) & (few->high[1][t] >= low[1] ? 1u : 0u) &
                  (few->low[2][t] <= high[2] ? 1u : 0u) & (few->high[2][t] >= low[2] ? 1u : 0u);
    }
    uint32_t count = 0;
    for (uint32_t t = 0; t < few->count; t++) {
        list[count] = t;
        count += near[t];
    }
    return count;
}

static float longest(const alpi_rays *rays)
{
    float reach = 0.0f;
    for (int i = 0; i < ALPI_PACKET; i++) {
        reach = rays->maximum[i] > reach ? rays->maximum[i] : reach;
    }
    return reach;
}

/// Packets that share their origins.
static void stop_rays(const alpi_few *few, alpi_rays *packets, uint32_t count,
                      const uint32_t lanes[ALPI_PACKET], bool one_sided)
{
    uint32_t list[ALPI_FEW_LIMIT];
    float reach = 0.0f;
    for (uint32_t packet = 0; packet < count; packet++) {
        reach = fmaxf(reach, longest(&packets[packet]));
    }
    const uint32_t near = list_near(few, packets, reach, list);
    for (uint32_t k = 0; k < near; k++) {
        for (int i = 0; i < ALPI_PACKET; i += WIDTH) {
            seen_triangle seen;
            see(few, list[k], packets, i, one_sided, &seen);
            const masks active = load_masks(lanes + i);
            for (alpi_rays *rays = packets; rays < packets + count; rays++) {
                met_triangle m;
                const floats maximum = load(rays->maximum + i);
                meet(&seen, rays, i, maximum, &m);
                const floats left = choose(m.met & active, (floats){0} - INFINITY, maximum);
                memcpy(rays->maximum + i, &left, sizeof left);
            }
        }
    }
}

static void occluded(const alpi_few *few, alpi_rays *packets, uint32_t count,
                     const uint32_t lanes[ALPI_PACKET], bool one_sided)
{
    for (uint32_t first = 0, end = 0; first < count; first = end) {
        for (end = first + 1; end < count && share_origins(&packets[first], &packets[end]);) {
            end++;
        }
        stop_rays(few, packets + first, end - first, lanes, one_sided);
    }
}

/// The nearest triangles of a packet so far.
typedef struct nearest_hits {
    floats distance;
    floats v, w, whole; // see met_triangle; whole: their sum with u
    masks triangle, behind;
} nearest_hits;

static inline void find_nearest(const alpi_few *few, const alpi_rays *rays, int i, bool one_sided,
                                const uint32_t *list, uint32_t near, nearest_hits *hits)
{
    const masks none = (masks){0} - 1;
    *hits = (nearest_hits){
        .distance = load(rays->maximum + i), .whole = (floats){0} + 1.0f, .triangle = none};
    for (uint32_t k = 0; k < near; k++) {
        seen_triangle seen;
        met_triangle m;
        see(few, list[k], rays, i, one_sided, &seen);
        meet(&seen, rays, i, hits->distance, &m);
        if (is_none(m.met)) {
            continue; // of eight rays that part two in three times
        }
        hits->distance = choose(m.met, m.height / m.reached, hits->distance);
        hits->v = choose(m.met, m.v, hits->v);
        hits->w = choose(m.met, m.w, hits->w);
        hits->whole = choose(m.met, m.u + m.v + m.w, hits->whole);
        hits->behind = (m.met & (m.along > 0.0f)) | (~m.met & hits->behind);
        hits->triangle = (m.met & (int32_t)few->triangle[list[k]]) | (~m.met & hits->triangle);
    }
}

static void nearest(const alpi_few *few, const alpi_rays *rays, uint32_t active, bool one_sided,
                    alpi_hits *hits)
{
    uint32_t list[ALPI_FEW_LIMIT];
    const uint32_t near = list_near(few, rays, longest(rays), list);
    hits->behind &= ~active;
    for (int i = 0; i < ALPI_PACKET; i += WIDTH) {
        nearest_hits found;
        find_nearest(few, rays, i, one_sided, list, near, &found);
        for (int k = 0; k < WIDTH; k++) {
            const int lane = i + k;
            if ((active >> lane & 1u) != 0) {
                const bool hit = found.triangle[k] != -1;
                hits->distance[lane] = hit ? found.distance[k] : INFINITY;
                hits->triangle[lane] = (uint32_t)found.triangle[k];
                hits->b1[lane] = found.v[k] / found.whole[k];
                hits->b2[lane] = found.w[k] / found.whole[k];
                hits->behind |= found.behind[k] != 0 ? 1u << lane : 0u;
            }
        }
    }
}

const alpi_few_loops ALPI_FEW_LOOPS = {occluded, nearest};
