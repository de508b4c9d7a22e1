// SPDX-License-Identifier: MIT
// Ear clipping: a convex corner is cut off when no other corner lies in its triangle; only corners
// that are not convex can, and these lie in the cells of a grid. A corner that is blocked waits for
// the one that blocks it and is asked again when that one is gone.
// Gary H. Meisters: Polygons have ears. American Mathematical Monthly 82(6), 1975.
// Newell's normal: Sutherland, Sproull, Schumacker. A Characterization of Ten Hidden-Surface
// Algorithms. ACM Computing Surveys 6, 1974.
#include "formats/polygon/polygon_ring.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum {
    CELL_SIDE_LIMIT = 1024,
    STEPS_PER_CORNER = 2048, // a comb of a million teeth takes a third of it
    PATIENCE = 256,          // steps to look into a triangle before smaller ones are tried
    FREE_STEPS = 1 << 14     // so that small faces are never given up
};

/// Of a cell: more than coordinates in cells, 1024 at most, are rounded by.
#define CELL_MARGIN 1e-6

typedef alpi_plane_point point;

typedef struct clipper {
    alpi_polygon_ring ring; // of what is left
    uint32_t count, left;   // corners, and those not cut off yet
    // Every corner left is in one circular list at most: that of the ones to be asked, of those on
    // a straight line, of those whose triangle takes long to look into (their heads are the last
    // three nodes), or of those that corner c blocks, whose head is node count + c.
    uint32_t *link_before, *link_behind; // [2 · count + 3]
    uint32_t *cell_first, *cell_next; // [cells], [count] corners that are not convex, count = end
    bool *convex, *gone;              // [count]
    bool *touches; // [count] it blocks another as its edges there lead into the other's triangle
    uint32_t side; // cells along each axis
    point low;
    double cells_x, cells_y; // per unit of length
    uint64_t steps, limit, patience;
    uint32_t (*triangles)[3];
    uint32_t made;
} clipper;

static uint32_t queue_of(const clipper *c)
{
    return 2 * c->count;
}

static uint32_t straight_of(const clipper *c)
{
    return 2 * c->count + 1;
}

static uint32_t later_of(const clipper *c)
{
    return 2 * c->count + 2;
}

static uint32_t spikes_of(const clipper *c)
{
    return 2 * c->count + 3;
}

// --- the plane -----------------------------------------------------------------------------------

static double finite_or_0(float value)
{
    return isfinite(value) ? (double)value : 0.0;
}

/// Normal whose length is twice the area (Newell), of corners taken from the first: far from the
/// origin products would lose the area.
static void find_normal(uint32_t count, const float (*corners)[3], double normal[3])
{
    double before[3] = {0.0, 0.0, 0.0};
    memset(normal, 0, 3 * sizeof *normal);
    for (uint32_t i = 1; i < count; i++) {
        double here[3];
        for (int k = 0; k < 3; k++) {
            here[k] = finite_or_0(corners[i][k]) - finite_or_0(corners[0][k]);
        }
        for (int k = 0; k < 3; k++) {
            int l = (k + 1) % 3, m = (k + 2) % 3;
            normal[k] += before[l] * here[m] - before[m] * here[l];
        }
        memcpy(before, here, sizeof before);
    }
}

/// Leaves out the axis the face looks along, so that coordinates stay exact; counter-clockwise.
static point project(const double normal[3], const float corner[3])
{
    int axis = 0;
    for (int k = 1; k < 3; k++) {
        axis = fabs(normal[k]) > fabs(normal[axis]) ? k : axis;
    }
    point p = {finite_or_0(corner[(axis + 1) % 3]), finite_or_0(corner[(axis + 2) % 3])};
    return normal[axis] < 0.0 ? (point){p.y, p.x} : p;
}

// --- lists ---------------------------------------------------------------------------------------

static void take_out(clipper *c, uint32_t node)
{
    c->link_behind[c->link_before[node]] = c->link_behind[node];
    c->link_before[c->link_behind[node]] = c->link_before[node];
    c->link_before[node] = c->link_behind[node] = node;
}

/// Moves a corner to the end of the list with this head.
static void move(clipper *c, uint32_t node, uint32_t head)
{
    take_out(c, node);
    c->link_before[node] = c->link_before[head];
    c->link_behind[node] = head;
    c->link_behind[c->link_before[head]] = node;
    c->link_before[head] = node;
}

/// A corner blocks no more: those that wait for it are asked again.
static void release(clipper *c, uint32_t corner)
{
    const uint32_t head = c->count + corner, queue = queue_of(c);
    c->touches[corner] = false;
    while (c->link_behind[head] != head) {
        move(c, c->link_behind[head], queue);
    }
}

// --- cells ---------------------------------------------------------------------------------------

/// Cells along a side for so many corners.
static size_t cell_side(size_t corners)
{
    size_t side = 1 + (size_t)sqrt((double)corners);
    return side < CELL_SIDE_LIMIT ? side : CELL_SIDE_LIMIT;
}

static uint32_t cell_at(double cells, uint32_t side)
{
    return cells <= 0.0 ? 0 : cells >= (double)(side - 1) ? side - 1 : (uint32_t)cells;
}

static void fill_cells(clipper *c)
{
    uint32_t blocking = 0;
    point high = c->ring.points[0];
    c->low = high;
    for (uint32_t i = 0; i < c->count; i++) {
        point p = c->ring.points[i];
        c->low = (point){fmin(c->low.x, p.x), fmin(c->low.y, p.y)};
        high = (point){fmax(high.x, p.x), fmax(high.y, p.y)};
        blocking += !c->convex[i];
    }
    const uint32_t side = c->side = (uint32_t)cell_side(blocking);
    c->cells_x = high.x > c->low.x ? side / (high.x - c->low.x) : 0.0;
    c->cells_y = high.y > c->low.y ? side / (high.y - c->low.y) : 0.0;
    for (uint32_t i = 0; i < side * side; i++) {
        c->cell_first[i] = c->count;
    }
    for (uint32_t i = c->count; i-- > 0;) {
        if (!c->convex[i]) {
            const uint32_t x = cell_at((c->ring.points[i].x - c->low.x) * c->cells_x, side);
            const uint32_t y = cell_at((c->ring.points[i].y - c->low.y) * c->cells_y, side);
            c->cell_next[i] = c->cell_first[y * side + x];
            c->cell_first[y * side + x] = i;
        }
    }
}

/// Whether an edge of the ring at `corner`, which is where corner `at` of the triangle is, leads
/// into it: so it is at the copies that the bridge to a hole makes.
static bool leads_inside(const clipper *c, uint32_t corner, const point triangle[3], int at)
{
    const uint32_t ends[2] = {c->ring.before[corner], c->ring.behind[corner]};
    const point before = triangle[(at + 2) % 3], here = triangle[at],
                after = triangle[(at + 1) % 3];
    for (int k = 0; k < 2; k++) {
        const point end = c->ring.points[ends[k]];
        if (alpi_plane_turn(before, here, end) > 0.0 && alpi_plane_turn(here, after, end) > 0.0) {
            return true;
        }
    }
    return false;
}

/// Whether a corner makes the triangle no ear: it lies in it, edges included, and is none of its
/// corners; where it lies on one of them, its edges decide.
static bool blocks(clipper *c, uint32_t corner, const uint32_t triangle[3])
{
    const point p = c->ring.points[corner];
    point t[3];
    for (int k = 0; k < 3; k++) {
        t[k] = c->ring.points[triangle[k]];
        if (corner == triangle[k]) {
            return false;
        }
    }
    for (int k = 0; k < 3; k++) {
        if (alpi_plane_turn(t[k], t[(k + 1) % 3], p) < 0.0) {
            return false;
        }
    }
    for (int k = 0; k < 3; k++) {
        if (alpi_plane_same(p, t[k])) {
            const bool inside = leads_inside(c, corner, t, k);
            c->touches[corner] |= inside;
            return inside;
        }
    }
    return true;
}

/// A corner of one cell that blocks the triangle, or count. Those that are convex now are dropped.
static uint32_t find_in_cell(clipper *c, uint32_t cell, const uint32_t triangle[3])
{
    uint32_t *at = &c->cell_first[cell];
    while (*at != c->count) {
        uint32_t corner = *at;
        c->steps++;
        if (c->convex[corner] || c->gone[corner]) {
            *at = c->cell_next[corner];
        } else if (blocks(c, corner, triangle)) {
            return corner;
        } else {
            at = &c->cell_next[corner];
        }
    }
    return c->count;
}

/// Where a triangle lies within a row of cells, all in cells: long thin triangles of a bounding box
/// would be asked for nearly every corner.
static void find_range(const point t[3], uint32_t row, double range[2])
{
    const double edges[2] = {row - CELL_MARGIN, row + 1 + CELL_MARGIN};
    range[0] = HUGE_VAL;
    range[1] = -HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const point a = t[k], b = t[(k + 1) % 3];
        double at[3] = {a.x, a.x, a.x};
        int count = a.y >= edges[0] && a.y <= edges[1];
        for (int e = 0; e < 2; e++) {
            if ((a.y < edges[e]) != (b.y < edges[e])) {
                at[count++] = a.x + (edges[e] - a.y) / (b.y - a.y) * (b.x - a.x);
            }
        }
        for (int i = 0; i < count; i++) {
            range[0] = fmin(range[0], at[i]);
            range[1] = fmax(range[1], at[i]);
        }
    }
}

/// A corner that blocks the triangle, or count; `triangle[1]` itself when patience ends before.
static uint32_t find_blocker(clipper *c, const uint32_t triangle[3])
{
    const uint64_t end = c->steps + c->patience;
    point t[3]; // in cells
    for (int k = 0; k < 3; k++) {
        const point p = c->ring.points[triangle[k]];
        t[k] = (point){(p.x - c->low.x) * c->cells_x, (p.y - c->low.y) * c->cells_y};
    }
    const double first = fmin(t[0].y, fmin(t[1].y, t[2].y)) - CELL_MARGIN;
    const uint32_t last = cell_at(fmax(t[0].y, fmax(t[1].y, t[2].y)) + CELL_MARGIN, c->side);
    for (uint32_t y = cell_at(first, c->side); y <= last; y++) {
        double range[2];
        find_range(t, y, range);
        const uint32_t right = cell_at(range[1] + CELL_MARGIN, c->side);
        for (uint32_t x = cell_at(range[0] - CELL_MARGIN, c->side); x <= right; x++) {
            const uint32_t found = find_in_cell(c, y * c->side + x, triangle);
            if (found != c->count) {
                return found;
            }
            if (++c->steps > end) {
                return triangle[1];
            }
        }
    }
    return c->count;
}

// --- cutting -------------------------------------------------------------------------------------

static double turn_at(const clipper *c, uint32_t corner)
{
    return alpi_plane_turn(c->ring.points[c->ring.before[corner]], c->ring.points[corner],
                           c->ring.points[c->ring.behind[corner]]);
}

/// Whether a corner on one line with those beside it lies between them.
static bool goes_on(const clipper *c, uint32_t corner)
{
    const point a = c->ring.points[c->ring.before[corner]], b = c->ring.points[corner];
    const point d = c->ring.points[c->ring.behind[corner]];
    return (b.x - a.x) * (d.x - b.x) + (b.y - a.y) * (d.y - b.y) > 0.0;
}

/// Into the list where it belongs by the angle it has now.
static void sort_in(clipper *c, uint32_t corner)
{
    const double turned = turn_at(c, corner);
    c->convex[corner] = turned > 0.0;
    if (turned > 0.0) {
        move(c, corner, queue_of(c));
    } else if (turned == 0.0) {
        move(c, corner, goes_on(c, corner) ? straight_of(c) : spikes_of(c));
    } else {
        take_out(c, corner);
    }
}

/// After its neighbour was cut off.
static void look_again(clipper *c, uint32_t corner)
{
    const bool was = c->convex[corner];
    sort_in(c, corner);
    if ((c->convex[corner] && !was) || c->touches[corner]) { // edges lead elsewhere now
        release(c, corner);
    }
}

static void cut_off(clipper *c, uint32_t corner)
{
    uint32_t before = c->ring.before[corner], behind = c->ring.behind[corner];
    memcpy(c->triangles[c->made++], (uint32_t[3]){before, corner, behind}, sizeof *c->triangles);
    c->ring.behind[before] = behind;
    c->ring.before[behind] = before;
    c->gone[corner] = true;
    c->left--;
    take_out(c, corner);
    release(c, corner);
    look_again(c, before);
    look_again(c, behind);
}

/// What is left, about one of its corners.
static void cut_fan(clipper *c, uint32_t first)
{
    for (uint32_t i = c->ring.behind[first]; c->left > 2; i = c->ring.behind[i]) {
        memcpy(c->triangles[c->made++], (uint32_t[3]){first, i, c->ring.behind[i]},
               sizeof *c->triangles);
        c->left--;
    }
}

/// What is cut where no ear is left: a corner on a straight line, whose triangle has no area, else
/// the widest angle there is, and then *clean is false. Steps pay for looking at all.
static uint32_t choose_without_ear(clipper *c, uint32_t from, bool *clean)
{
    const uint32_t straight = straight_of(c);
    if (c->link_behind[straight] != straight) {
        return c->link_behind[straight];
    }
    uint32_t best = from;
    double best_turn = -HUGE_VAL;
    *clean = false;
    for (uint32_t k = 0, i = from; k < c->left; k++, i = c->ring.behind[i]) {
        const double turned = turn_at(c, i);
        best = turned > best_turn ? i : best;
        best_turn = fmax(turned, best_turn);
    }
    c->steps += c->left;
    return best;
}

/// The corner to be asked next: of those put off, with more patience, where no other is left.
/// @return the head of the queue where there is none
static uint32_t next_corner(clipper *c)
{
    const uint32_t queue = queue_of(c), later = later_of(c);
    if (c->link_behind[queue] == queue && c->link_behind[later] != later) {
        c->patience *= 4;
        c->link_behind[queue] = c->link_behind[later]; // the whole list
        c->link_before[queue] = c->link_before[later];
        c->link_before[c->link_behind[queue]] = c->link_behind[c->link_before[queue]] = queue;
        c->link_before[later] = c->link_behind[later] = later;
    }
    return c->link_behind[queue];
}

/// @return whether every corner that was cut off was an ear, or without area
static bool cut_ears(clipper *c)
{
    bool clean = true;
    uint32_t last = 0; // a corner that is left
    c->patience = PATIENCE;
    while (c->left > 3 && c->steps < c->limit) {
        uint32_t corner = next_corner(c), blocker = c->count;
        c->steps++;
        if (c->link_behind[spikes_of(c)] != spikes_of(c)) { // goes away before it can be in a way
            corner = c->link_behind[spikes_of(c)];
        } else if (corner == queue_of(c)) {
            corner = choose_without_ear(c, last, &clean);
        } else {
            const uint32_t triangle[3] = {c->ring.before[corner], corner, c->ring.behind[corner]};
            blocker = find_blocker(c, triangle);
        }
        if (blocker == corner) { // small ears first: they make this triangle smaller or go away
            move(c, corner, later_of(c));
        } else if (blocker != c->count) {
            move(c, corner, c->count + blocker);
        } else {
            last = c->ring.before[corner];
            cut_off(c, corner);
        }
    }
    clean = clean && c->left == 3;
    cut_fan(c, last);
    return clean;
}

static void start(clipper *c)
{
    for (uint32_t i = 0; i <= spikes_of(c); i++) {
        c->link_before[i] = c->link_behind[i] = i;
    }
    for (uint32_t i = 0; i < c->count; i++) {
        c->gone[i] = c->touches[i] = false;
        sort_in(c, i);
    }
    fill_cells(c);
}

// --- the face ------------------------------------------------------------------------------------

static void *take(uint8_t *base, size_t *used, size_t count, size_t size)
{
    void *taken = base != NULL ? base + *used : NULL;
    *used += (count * size + 15) / 16 * 16;
    return taken;
}

/// Lays the arrays out from `base` (NULL: only to see how much they take). @return bytes
static size_t lay_out(clipper *c, uint8_t *base)
{
    size_t used = 0, n = c->count, side = cell_side(n);
    alpi_polygon_ring *ring = &c->ring;
    ring->points = take(base, &used, n, sizeof *ring->points);
    ring->origins = take(base, &used, n, sizeof *ring->origins);
    ring->before = take(base, &used, n, sizeof *ring->before);
    ring->behind = take(base, &used, n, sizeof *ring->behind);
    c->link_before = take(base, &used, 2 * n + 4, sizeof *c->link_before);
    c->link_behind = take(base, &used, 2 * n + 4, sizeof *c->link_behind);
    c->cell_first = take(base, &used, side * side, sizeof *c->cell_first);
    c->cell_next = take(base, &used, n, sizeof *c->cell_next);
    c->convex = take(base, &used, n, sizeof *c->convex);
    c->gone = take(base, &used, n, sizeof *c->gone);
    c->touches = take(base, &used, n, sizeof *c->touches);
    return used;
}

static alp_result make_room(alpi_polygon_scratch *scratch, clipper *c)
{
    size_t size = lay_out(c, NULL);
    if (size > scratch->size) {
        alpi_release(scratch->context, scratch->memory);
        scratch->size = 0;
        scratch->memory = alpi_allocate(scratch->context, size, 1);
        if (scratch->memory == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        scratch->size = size;
    }
    lay_out(c, scratch->memory);
    return ALP_OK;
}

static void make_fan(uint32_t count, uint32_t (*triangles)[3])
{
    for (uint32_t i = 0; i + 2 < count; i++) {
        memcpy(triangles[i], (uint32_t[3]){0, i + 1, i + 2}, sizeof *triangles);
    }
}

/// Whether a fan about the first corner is right: every corner and every triangle turns left.
static bool is_fan(uint32_t count, const float (*corners)[3], const double normal[3])
{
    const point first = project(normal, corners[0]);
    point b = project(normal, corners[count - 1]), c = first;
    for (uint32_t i = 0; i < count; i++) {
        point a = b;
        b = c;
        c = i + 1 < count ? project(normal, corners[i + 1]) : first;
        const bool is_triangle = i > 0 && i + 1 < count;
        if (!(alpi_plane_turn(a, b, c) > 0.0) ||
            (is_triangle && !(alpi_plane_turn(first, b, c) > 0.0))) {
            return false;
        }
    }
    return true;
}

/// Four corners: the diagonal that leaves two triangles turning the same way, the first corner's
/// where both do. @return whether there is one
static bool cut_quad(const float (*corners)[3], const double normal[3], uint32_t (*triangles)[3])
{
    point k[4];
    for (int i = 0; i < 4; i++) {
        k[i] = project(normal, corners[i]);
    }
    const double from_0 =
        fmin(alpi_plane_turn(k[0], k[1], k[2]), alpi_plane_turn(k[0], k[2], k[3]));
    const double from_1 =
        fmin(alpi_plane_turn(k[1], k[2], k[3]), alpi_plane_turn(k[1], k[3], k[0]));
    const uint32_t first = from_0 <= 0.0 && from_1 > from_0 ? 1 : 0;
    for (uint32_t t = 0; t < 2; t++) {
        memcpy(triangles[t], (uint32_t[3]){first, (first + 1 + t) % 4, (first + 2 + t) % 4},
               sizeof *triangles);
    }
    return fmax(from_0, from_1) >= 0.0;
}

/// Everything that is no fan.
static alp_result clip(alpi_polygon_scratch *scratch, const alpi_polygon_rings *polygon,
                       const double normal[3], uint32_t (*triangles)[3], bool *clean)
{
    const uint32_t corner_count = polygon->ends[polygon->count - 1];
    const uint32_t count = corner_count + 2 * (polygon->count - 1);
    clipper c = {.count = count, .left = count, .triangles = triangles};
    bool outside = false;
    ALP_TRY(make_room(scratch, &c));
    c.ring.count = corner_count;
    for (uint32_t i = 0; i < corner_count; i++) {
        c.ring.points[i] = project(normal, polygon->points[i]);
        c.ring.origins[i] = i;
    }
    alpi_polygon_link(&c.ring, 0, polygon->ends[0], false);
    if (polygon->count > 1) {
        ALP_TRY(alpi_polygon_join_holes(scratch, polygon, &c.ring, &outside));
    }
    c.limit = (uint64_t)STEPS_PER_CORNER * count + FREE_STEPS;
    start(&c);
    *clean = cut_ears(&c) && !outside;
    scratch->work += c.steps;
    for (uint32_t t = 0; t < c.made; t++) {
        for (int k = 0; k < 3; k++) {
            triangles[t][k] = c.ring.origins[triangles[t][k]];
        }
    }
    return ALP_OK;
}

uint32_t alpi_polygon_triangle_count(const alpi_polygon_rings *polygon)
{
    return polygon->ends[polygon->count - 1] + 2 * (polygon->count - 1) - 2;
}

alp_result alpi_polygon_triangulate_rings(alpi_polygon_scratch *scratch,
                                          const alpi_polygon_rings *polygon,
                                          uint32_t (*triangles)[3], bool *clean)
{
    const uint32_t count = polygon->ends[0]; // of the outline
    const float(*corners)[3] = polygon->points;
    double normal[3];
    *clean = true;
    if (polygon->count == 1 && count == 3) {
        make_fan(count, triangles);
        return ALP_OK;
    }
    find_normal(count, corners, normal);
    const bool flat = normal[0] == 0.0 && normal[1] == 0.0 && normal[2] == 0.0;
    if (polygon->count == 1 && count == 4) {
        *clean = cut_quad(corners, normal, triangles);
        return ALP_OK;
    }
    if (polygon->count == 1 && (flat || is_fan(count, corners, normal))) {
        make_fan(count, triangles);
        return ALP_OK;
    }
    return clip(scratch, polygon, normal, triangles, clean);
}

alp_result alpi_polygon_triangulate(alpi_polygon_scratch *scratch, uint32_t count,
                                    const float (*corners)[3], uint32_t (*triangles)[3],
                                    bool *clean)
{
    const alpi_polygon_rings polygon = {corners, &count, 1};
    return alpi_polygon_triangulate_rings(scratch, &polygon, triangles, clean);
}

void alpi_polygon_scratch_destroy(alpi_polygon_scratch *scratch)
{
    alpi_release(scratch->context, scratch->memory);
    *scratch = (alpi_polygon_scratch){.context = scratch->context};
}
