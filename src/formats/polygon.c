// SPDX-License-Identifier: MIT
// Ear clipping: a convex corner is cut off when no other corner lies in its triangle; only corners
// that are not convex can, and these lie in the cells of a grid. A corner that is blocked waits for
// the one that blocks it and is asked again when that one is gone.
// Gary H. Meisters: Polygons have ears. American Mathematical Monthly 82(6), 1975.
#include "formats/polygon.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum {
    CELL_SIDE_LIMIT = 1024,
    STEPS_PER_CORNER = 2048, // a comb of a million teeth takes a third of it
    PATIENCE = 256,          // steps to look into a triangle before smaller ones are tried
    FREE_STEPS = 1 << 14     // so that small faces are never given up
};

typedef struct point {
    double x, y;
} point;

typedef struct clipper {
    uint32_t count, left;      // corners, and those not cut off yet
    point *points;             // [count] in the plane, counter-clockwise
    uint32_t *before, *behind; // [count] the ring of what is left
    // Every corner left is in one circular list at most: that of the ones to be asked, whose head
    // is node 2 · count, or of those that corner c blocks, whose head is node count + c.
    uint32_t *link_before, *link_behind; // [2 · count + 1]
    uint32_t *cell_first, *cell_next; // [cells], [count] corners that are not convex, count = end
    bool *convex, *gone;              // [count]
    uint32_t side;                    // cells along each axis
    point low;
    double cells_x, cells_y; // per unit of length
    uint64_t steps, limit, patience;
    uint32_t (*triangles)[3];
    uint32_t made;
} clipper;

/// Twice the signed area of a triangle.
static double turn(point a, point b, point c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static bool same_point(point a, point b)
{
    return a.x == b.x && a.y == b.y;
}

// --- the plane -----------------------------------------------------------------------------------

/// Normal whose length is twice the area (Newell), of corners taken from the first.
static void find_normal(uint32_t count, const float (*corners)[3], double normal[3])
{
    double before[3] = {0.0, 0.0, 0.0};
    memset(normal, 0, 3 * sizeof *normal);
    for (uint32_t i = 1; i < count; i++) {
        double here[3];
        for (int k = 0; k < 3; k++) {
            here[k] = (double)corners[i][k] - (double)corners[0][k];
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
    point p = {(double)corner[(axis + 1) % 3], (double)corner[(axis + 2) % 3]};
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
    const uint32_t head = c->count + corner, queue = 2 * c->count;
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

static uint32_t cell_along(double place, double cells, uint32_t side)
{
    double cell = place * cells; // not NaN: the extent is finite
    return cell <= 0.0 ? 0 : cell >= (double)(side - 1) ? side - 1 : (uint32_t)cell;
}

static void fill_cells(clipper *c, uint32_t side)
{
    point high = c->points[0];
    c->low = c->points[0];
    c->side = side;
    for (uint32_t i = 1; i < c->count; i++) {
        point p = c->points[i];
        c->low = (point){fmin(c->low.x, p.x), fmin(c->low.y, p.y)};
        high = (point){fmax(high.x, p.x), fmax(high.y, p.y)};
    }
    c->cells_x = high.x > c->low.x ? side / (high.x - c->low.x) : 0.0;
    c->cells_y = high.y > c->low.y ? side / (high.y - c->low.y) : 0.0;
    for (uint32_t i = 0; i < side * side; i++) {
        c->cell_first[i] = c->count;
    }
    for (uint32_t i = c->count; i-- > 0;) {
        if (!c->convex[i]) {
            uint32_t x = cell_along(c->points[i].x - c->low.x, c->cells_x, side);
            uint32_t y = cell_along(c->points[i].y - c->low.y, c->cells_y, side);
            c->cell_next[i] = c->cell_first[y * side + x];
            c->cell_first[y * side + x] = i;
        }
    }
}

/// Whether a corner lies in a triangle, its edges included, and is none of its corners, nor where
/// one of them is (edges that touch, such as the bridge to a hole).
static bool lies_inside(const clipper *c, uint32_t corner, const uint32_t triangle[3])
{
    point p = c->points[corner];
    for (int k = 0; k < 3; k++) {
        point a = c->points[triangle[k]], b = c->points[triangle[(k + 1) % 3]];
        if (corner == triangle[k] || same_point(p, a) || turn(a, b, p) < 0.0) {
            return false;
        }
    }
    return true;
}

/// A corner of one cell that lies in the triangle, or count. Those that are convex now are dropped.
static uint32_t find_in_cell(clipper *c, uint32_t cell, const uint32_t triangle[3])
{
    uint32_t *at = &c->cell_first[cell];
    while (*at != c->count) {
        uint32_t corner = *at;
        c->steps++;
        if (c->convex[corner] || c->gone[corner]) {
            *at = c->cell_next[corner];
        } else if (lies_inside(c, corner, triangle)) {
            return corner;
        } else {
            at = &c->cell_next[corner];
        }
    }
    return c->count;
}

/// A corner that lies in the triangle, or count; `triangle[1]` itself when patience ends before.
static uint32_t find_blocker(clipper *c, const uint32_t triangle[3])
{
    const uint64_t end = c->steps + c->patience;
    point a = c->points[triangle[0]], b = c->points[triangle[1]], d = c->points[triangle[2]];
    double x0 = fmin(a.x, fmin(b.x, d.x)), x1 = fmax(a.x, fmax(b.x, d.x));
    double y0 = fmin(a.y, fmin(b.y, d.y)), y1 = fmax(a.y, fmax(b.y, d.y));
    uint32_t left = cell_along(x0 - c->low.x, c->cells_x, c->side);
    uint32_t right = cell_along(x1 - c->low.x, c->cells_x, c->side);
    uint32_t top = cell_along(y1 - c->low.y, c->cells_y, c->side);
    for (uint32_t y = cell_along(y0 - c->low.y, c->cells_y, c->side); y <= top; y++) {
        for (uint32_t x = left; x <= right; x++) {
            uint32_t found = find_in_cell(c, y * c->side + x, triangle);
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

static bool is_convex(const clipper *c, uint32_t corner)
{
    return turn(c->points[c->before[corner]], c->points[corner], c->points[c->behind[corner]]) >
           0.0;
}

/// After its neighbour was cut off.
static void look_again(clipper *c, uint32_t corner)
{
    bool was = c->convex[corner];
    c->convex[corner] = is_convex(c, corner);
    if (c->convex[corner]) {
        move(c, corner, 2 * c->count);
    } else {
        take_out(c, corner);
    }
    if (c->convex[corner] && !was) {
        release(c, corner);
    }
}

static void cut_off(clipper *c, uint32_t corner)
{
    uint32_t before = c->before[corner], behind = c->behind[corner];
    memcpy(c->triangles[c->made++], (uint32_t[3]){before, corner, behind}, sizeof *c->triangles);
    c->behind[before] = behind;
    c->before[behind] = before;
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
    for (uint32_t i = c->behind[first]; c->left > 2; i = c->behind[i]) {
        memcpy(c->triangles[c->made++], (uint32_t[3]){first, i, c->behind[i]},
               sizeof *c->triangles);
        c->left--;
    }
}

/// @return whether every corner that was cut off was an ear
static bool cut_ears(clipper *c)
{
    const uint32_t queue = 2 * c->count;
    uint32_t last = 0;           // a corner that is left
    uint32_t put_off = c->count; // the first since the last ear whose triangle took too long
    c->patience = PATIENCE;
    while (c->left > 3 && c->link_behind[queue] != queue && c->steps < c->limit) {
        uint32_t corner = c->link_behind[queue];
        const uint32_t triangle[3] = {c->before[corner], corner, c->behind[corner]};
        uint32_t blocker = find_blocker(c, triangle);
        c->steps++;
        if (blocker == corner) { // small ears first: they make this triangle smaller or go away
            move(c, corner, queue);
            c->patience *= put_off == corner ? 4 : 1; // once round without an ear
            put_off = put_off == c->count ? corner : put_off;
        } else if (blocker != c->count) {
            move(c, corner, c->count + blocker);
        } else {
            last = triangle[0];
            cut_off(c, corner);
            put_off = c->count;
        }
    }
    const bool clean = c->left == 3;
    cut_fan(c, last);
    return clean;
}

static void start(clipper *c)
{
    for (uint32_t i = 0; i < c->count; i++) {
        c->before[i] = i > 0 ? i - 1 : c->count - 1;
        c->behind[i] = i + 1 < c->count ? i + 1 : 0;
        c->gone[i] = false;
    }
    for (uint32_t i = 0; i <= 2 * c->count; i++) {
        c->link_before[i] = c->link_behind[i] = i;
    }
    uint32_t blocking = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        c->convex[i] = is_convex(c, i);
        blocking += !c->convex[i];
        if (c->convex[i]) {
            move(c, i, 2 * c->count);
        }
    }
    fill_cells(c, (uint32_t)cell_side(blocking));
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
    c->points = take(base, &used, n, sizeof *c->points);
    c->before = take(base, &used, n, sizeof *c->before);
    c->behind = take(base, &used, n, sizeof *c->behind);
    c->link_before = take(base, &used, 2 * n + 1, sizeof *c->link_before);
    c->link_behind = take(base, &used, 2 * n + 1, sizeof *c->link_behind);
    c->cell_first = take(base, &used, side * side, sizeof *c->cell_first);
    c->cell_next = take(base, &used, n, sizeof *c->cell_next);
    c->convex = take(base, &used, n, sizeof *c->convex);
    c->gone = take(base, &used, n, sizeof *c->gone);
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
        bool is_triangle = i > 0 && i + 1 < count;
        if (!(turn(a, b, c) > 0.0) || (is_triangle && !(turn(first, b, c) > 0.0))) {
            return false;
        }
    }
    return true;
}

alp_result alpi_polygon_triangulate(alpi_polygon_scratch *scratch, uint32_t count,
                                    const float (*corners)[3], uint32_t (*triangles)[3],
                                    bool *clean)
{
    double normal[3];
    find_normal(count, corners, normal);
    const bool flat = normal[0] == 0.0 && normal[1] == 0.0 && normal[2] == 0.0;
    *clean = true;
    if (count == 3 || flat || is_fan(count, corners, normal)) {
        make_fan(count, triangles);
        return ALP_OK;
    }
    clipper c = {.count = count, .left = count, .triangles = triangles};
    ALP_TRY(make_room(scratch, &c));
    for (uint32_t i = 0; i < count; i++) {
        c.points[i] = project(normal, corners[i]);
    }
    c.limit = (uint64_t)STEPS_PER_CORNER * count + FREE_STEPS;
    start(&c);
    *clean = cut_ears(&c);
    scratch->work += c.steps;
    return ALP_OK;
}

void alpi_polygon_scratch_destroy(alpi_polygon_scratch *scratch)
{
    alpi_release(scratch->context, scratch->memory);
    *scratch = (alpi_polygon_scratch){.context = scratch->context};
}
