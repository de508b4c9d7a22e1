// SPDX-License-Identifier: MIT
// The tightest box round points of the plane: convex hull and rotating calipers.
#include "atlas/box.h"

#include "base/angle.h"

#include <math.h>
#include <stdlib.h>

static int compare_points(const void *a, const void *b)
{
    const alpi_point *p = a, *q = b;
    if (p->x != q->x) {
        return p->x < q->x ? -1 : 1;
    }
    return p->y < q->y ? -1 : p->y > q->y;
}

static double cross(alpi_point o, alpi_point a, alpi_point b)
{
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// Counter-clockwise hull without points on its sides; its size.
static size_t convex_hull(alpi_point *points, size_t count, alpi_point *hull)
{
    qsort(points, count, sizeof *points, compare_points);
    size_t size = 0;
    for (size_t i = 0; i < count; i++) { // lower side, from left to right
        while (size >= 2 && cross(hull[size - 2], hull[size - 1], points[i]) <= 0.0) {
            size--;
        }
        hull[size++] = points[i];
    }
    size_t lower = size + 1;
    for (size_t i = count - 1; i-- > 0;) { // upper side, back
        while (size >= lower && cross(hull[size - 2], hull[size - 1], points[i]) <= 0.0) {
            size--;
        }
        hull[size++] = points[i];
    }
    return size > 1 ? size - 1 : size; // the last point is the first again
}

static double along(alpi_point axis, alpi_point p)
{
    return axis.x * p.x + axis.y * p.y;
}

static double across(alpi_point axis, alpi_point p)
{
    return axis.x * p.y - axis.y * p.x;
}

static alpi_box box_of(alpi_point axis, const alpi_point *hull, size_t size)
{
    double low_x = HUGE_VAL, high_x = -HUGE_VAL, low_y = HUGE_VAL, high_y = -HUGE_VAL;
    for (size_t i = 0; i < size; i++) {
        double x = along(axis, hull[i]), y = across(axis, hull[i]);
        low_x = fmin(low_x, x);
        high_x = fmax(high_x, x);
        low_y = fmin(low_y, y);
        high_y = fmax(high_y, y);
    }
    return (alpi_box){axis, low_x, low_y, high_x - low_x, high_y - low_y};
}

/// Moves a caliper round the hull as long as `axis` (turned by `quarter` × 90°) says it gets
/// farther.
static size_t advance(const alpi_point *hull, size_t size, size_t at, alpi_point axis, int quarter)
{
    alpi_point direction = quarter == 0   ? axis
                           : quarter == 1 ? (alpi_point){-axis.y, axis.x}
                                          : (alpi_point){-axis.x, -axis.y};
    for (size_t steps = 0; steps < size; steps++) {
        size_t next = at + 1 == size ? 0 : at + 1;
        if (along(direction, hull[next]) <= along(direction, hull[at])) {
            break;
        }
        at = next;
    }
    return at;
}

alpi_box alpi_tightest_box(alpi_point *points, size_t count, alpi_point *hull)
{
    size_t size = convex_hull(points, count, hull);
    alpi_box best = box_of((alpi_point){1.0, 0.0}, hull, size);
    double best_area = best.width * best.height;
    size_t calipers[3] = {0, 0, 0}; // farthest along, across and against the side
    for (size_t i = 0; i < size; i++) {
        alpi_point p = hull[i], q = hull[i + 1 == size ? 0 : i + 1];
        double length = alpi_length2(q.x - p.x, q.y - p.y);
        if (!(length > 0.0)) {
            continue;
        }
        alpi_point axis = {(q.x - p.x) / length, (q.y - p.y) / length};
        for (int k = 0; k < 3; k++) {
            size_t from = k > 0 && i == 0 ? calipers[k - 1] : calipers[k];
            calipers[k] = advance(hull, size, from, axis, k);
        }
        double width = along(axis, hull[calipers[0]]) - along(axis, hull[calipers[2]]);
        double height = across(axis, hull[calipers[1]]) - across(axis, p);
        if (width * height < best_area * (1.0 - 1e-9)) { // a real gain: axis-aligned stays so
            best_area = width * height;
            best = box_of(axis, hull, size);
        }
    }
    return best;
}

// --- triangles -----------------------------------------------------------------------------------

alpi_box alpi_lowest_box(const alpi_point triangle[3])
{
    double longest = 0.0;
    alpi_point axis = {1.0, 0.0};
    for (int k = 0; k < 3; k++) {
        const alpi_point p = triangle[k], q = triangle[k == 2 ? 0 : k + 1];
        const double length = alpi_length2(q.x - p.x, q.y - p.y);
        if (length > longest) {
            longest = length;
            axis = (alpi_point){(q.x - p.x) / length, (q.y - p.y) / length};
        }
    }
    return box_of(axis, triangle, 3);
}

/// Takes the box along `direction` where its longer side is shorter.
static void try_square(alpi_point direction, const alpi_point triangle[3], alpi_box *best)
{
    const double length = alpi_length2(direction.x, direction.y);
    if (length > 0.0) {
        const alpi_point axis = {direction.x / length, direction.y / length};
        const alpi_box box = box_of(axis, triangle, 3);
        *best = fmax(box.width, box.height) < fmax(best->width, best->height) ? box : *best;
    }
}

/// Over the angle the width of a triangle is that of one edge after the other, each a cosine, and
/// its height the same a quarter later. The greater of the two is least where one is, along an
/// edge, or where they are equal: |e·a| = |f·a'|, a' being a turned by a quarter, for two edges or
/// one. Then a is at right angles to the sum or the difference of e and f', f turned back.
alpi_box alpi_smallest_square(const alpi_point triangle[3])
{
    alpi_point edges[3];
    for (int k = 0; k < 3; k++) {
        const alpi_point p = triangle[k], q = triangle[k == 2 ? 0 : k + 1];
        edges[k] = (alpi_point){q.x - p.x, q.y - p.y};
    }
    alpi_box best = box_of((alpi_point){1.0, 0.0}, triangle, 3);
    for (int i = 0; i < 3; i++) {
        try_square(edges[i], triangle, &best);
        for (int j = 0; j < 3; j++) {
            const alpi_point e = edges[i], turned = {edges[j].y, -edges[j].x};
            try_square((alpi_point){turned.y - e.y, e.x - turned.x}, triangle, &best);
            try_square((alpi_point){turned.y + e.y, -e.x - turned.x}, triangle, &best);
        }
    }
    return best;
}
