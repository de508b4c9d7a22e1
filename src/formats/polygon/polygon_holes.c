// SPDX-License-Identifier: MIT
// Holes of a polygon joined to its outline by bridges, so that one ring is left to be cut.
// David Eberly. Triangulation by Ear Clipping. Geometric Tools, 2002.
#include "formats/polygon/polygon_ring.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

#define NONE UINT32_MAX
/// Bridges look at every corner for every hole: about two seconds of looking, for a whole file.
#define BRIDGE_LIMIT ((uint64_t)1 << 30)

typedef alpi_plane_point point;

static void link_corners(alpi_polygon_ring *ring, uint32_t first, uint32_t second)
{
    ring->behind[first] = second;
    ring->before[second] = first;
}

void alpi_polygon_link(alpi_polygon_ring *ring, uint32_t begin, uint32_t end, bool turned)
{
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t next = i + 1 < end ? i + 1 : begin;
        link_corners(ring, turned ? next : i, turned ? i : next);
    }
}

// --- holes ---------------------------------------------------------------------------------------

/// A hole and its rightmost corner.
typedef struct hole {
    double x;
    uint32_t corner;
} hole;

/// Makes a ring that turns clockwise.
static hole link_hole(alpi_polygon_ring *ring, uint32_t begin, uint32_t end)
{
    const point *p = ring->points;
    double area = 0.0;
    for (uint32_t i = begin + 1; i + 1 < end; i++) {
        area += alpi_plane_turn(p[begin], p[i], p[i + 1]);
    }
    alpi_polygon_link(ring, begin, end, area > 0.0);
    uint32_t best = begin;
    for (uint32_t i = begin; i < end; i++) {
        best = p[i].x > p[best].x ? i : best;
    }
    return (hole){p[best].x, best};
}

/// Those furthest to the right first, else in the order of the file.
static int compare_holes(const void *left, const void *right)
{
    const hole *a = left, *b = right;
    return a->x != b->x ? (a->x < b->x) - (a->x > b->x)
                        : (a->corner > b->corner) - (a->corner < b->corner);
}

// --- what a hole sees ----------------------------------------------------------------------------

static bool in_triangle(point a, point b, point c, point p)
{
    return alpi_plane_turn(a, b, p) >= 0.0 && alpi_plane_turn(b, c, p) >= 0.0 &&
           alpi_plane_turn(c, a, p) >= 0.0;
}

/// Whether the direction from corner `at` of the ring to p starts inside the polygon.
static bool starts_inside(const alpi_polygon_ring *ring, uint32_t at, point p)
{
    const point a = ring->points[at];
    const point before = ring->points[ring->before[at]], after = ring->points[ring->behind[at]];
    const double in = alpi_plane_turn(before, a, p), out = alpi_plane_turn(a, after, p);
    return alpi_plane_turn(before, a, after) > 0.0 ? in > 0.0 && out > 0.0
                                                   : !(in < 0.0 && out < 0.0);
}

/// The edge of the ring at `outer` that a ray from m towards +x meets first: the end of it that
/// lies further to the right; *x is where. NONE: it meets none.
static uint32_t edge_right_of(const alpi_polygon_ring *ring, uint32_t outer, point m, double *x)
{
    uint32_t best = NONE, i = outer;
    *x = HUGE_VAL;
    do {
        const uint32_t next = ring->behind[i];
        const point a = ring->points[i], b = ring->points[next];
        if (a.y <= m.y && b.y >= m.y && a.y != b.y) { // upwards: inside is on its left
            const double at = a.x + (m.y - a.y) / (b.y - a.y) * (b.x - a.x);
            if (at >= m.x && at < *x) {
                *x = at;
                best = a.x > b.x ? i : next;
                best = a.y == m.y ? i : b.y == m.y ? next : best; // an end itself is seen
            }
        }
        i = next;
    } while (i != outer);
    return best;
}

/// Of the corners where `found` is, one that looks towards the hole.
static uint32_t choose_copy(const alpi_polygon_ring *ring, uint32_t found, point m)
{
    uint32_t i = found;
    do {
        if (alpi_plane_same(ring->points[i], ring->points[found]) && starts_inside(ring, i, m)) {
            return i;
        }
        i = ring->behind[i];
    } while (i != found);
    return found;
}

/// A corner of the ring that the rightmost corner m of a hole sees: Eberly's rule.
static uint32_t visible_corner(const alpi_polygon_ring *ring, uint32_t outer, point m,
                               bool *outside)
{
    double x;
    const uint32_t found = edge_right_of(ring, outer, m, &x);
    if (found == NONE) {
        *outside = true;
        return outer;
    }
    const point hit = {x, m.y}, p = ring->points[found];
    if (alpi_plane_same(p, hit)) {
        return choose_copy(ring, found, m);
    }
    const bool above = p.y > m.y;
    double best_slope = HUGE_VAL;
    uint32_t best = found, i = outer;
    do { // what lies inside m, hit, p hides p: take the one nearest to the ray
        const point q = ring->points[i];
        const bool inside = above ? in_triangle(m, hit, p, q) : in_triangle(m, p, hit, q);
        if (inside && q.x > m.x && starts_inside(ring, i, m)) {
            const double slope = fabs(q.y - m.y) / (q.x - m.x);
            if (slope < best_slope || (slope == best_slope && q.x < ring->points[best].x)) {
                best_slope = slope;
                best = i;
            }
        }
        i = ring->behind[i];
    } while (i != outer);
    return best;
}

// --- bridges -------------------------------------------------------------------------------------

static uint32_t copy_corner(alpi_polygon_ring *ring, uint32_t corner)
{
    ring->points[ring->count] = ring->points[corner];
    ring->origins[ring->count] = ring->origins[corner];
    return ring->count++;
}

/// Cuts the polygon open from corner `outer` to corner `inner` of a hole: both are there twice
/// then.
static void build_bridge(alpi_polygon_ring *ring, uint32_t outer, uint32_t inner)
{
    const uint32_t outer_next = ring->behind[outer], inner_last = ring->before[inner];
    const uint32_t inner_copy = copy_corner(ring, inner), outer_copy = copy_corner(ring, outer);
    link_corners(ring, outer, inner);
    link_corners(ring, inner_last, inner_copy);
    link_corners(ring, inner_copy, outer_copy);
    link_corners(ring, outer_copy, outer_next);
}

alp_result alpi_polygon_join_holes(alpi_polygon_scratch *scratch, const alpi_polygon_rings *polygon,
                                   alpi_polygon_ring *ring, bool *outside)
{
    const uint32_t count = polygon->count - 1;
    const uint64_t corners = (uint64_t)ring->count + 2 * (uint64_t)count;
    const uint64_t left = BRIDGE_LIMIT - scratch->bridge_work;
    if (count > 0 && corners > left / count) {
        return alpi_fail(scratch->context, ALP_ERROR_LIMIT,
                         "a polygon has %u holes and %u corners: joining these and earlier ones "
                         "takes more than %llu steps; cut them into triangles before export",
                         count, ring->count, (unsigned long long)BRIDGE_LIMIT);
    }
    scratch->bridge_work += corners * count;
    hole *holes = ALPI_NEW(scratch->context, hole, count);
    if (holes == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t h = 0; h < count; h++) {
        holes[h] = link_hole(ring, polygon->ends[h], polygon->ends[h + 1]);
    }
    qsort(holes, count, sizeof *holes, compare_holes);
    for (uint32_t h = 0; h < count; h++) {
        const uint32_t inner = holes[h].corner;
        build_bridge(ring, visible_corner(ring, 0, ring->points[inner], outside), inner);
    }
    alpi_release(scratch->context, holes);
    return ALP_OK;
}
