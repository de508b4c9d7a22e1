// SPDX-License-Identifier: MIT
// Clips the triangles of a page against its texels, row by row from the top: exact areas, and one
// receiver for each texel.
// Based on: I. E. Sutherland, G. W. Hodgman. Reentrant Polygon Clipping. CACM 17(1), 1974.
#include "atlas/stages.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>

// A piece counts when it is more than this share of a texel, or of its triangle if that is smaller.
static const double SMALLEST_PIECE = 1e-6;
// Triangles that cover more than this share of a texel together must overlap.
static const double FULL_TEXEL = 1.02;
// A centre this far inside two triangles (in texels) is in both, not on the edge between them.
static const double CENTER_MARGIN = 1e-3;

enum {
    POLYGON_LIMIT = 8,      // a triangle cut by four lines has at most 7 corners
    TICK_INTERVAL = 1 << 14 // triangles between two questions whether to go on
};

typedef struct polygon {
    int count;
    double p[POLYGON_LIMIT][2];
} polygon;

/// A triangle of the page that reaches the current row, counter-clockwise, in texels.
typedef struct active {
    double p[3][2];
    double area, world_per_texel; // texels; m² per texel
    uint32_t triangle;
    uint32_t first_row, last_row, first_column, last_column;
} active;

typedef struct raster {
    const alp_atlas *atlas;
    uint32_t *row_first; // [height] first triangle that begins in the row, ALPI_NONE = none
    uint32_t *next;      // [triangle_count] the next one of the same row
    active *actives;
    size_t active_count, active_capacity;
    alpi_cell *cells; // [width]
} raster;

// --- clipping ------------------------------------------------------------------------------------

/// The part of `in` with coordinate `axis` ≤ at (keep_low) or ≥ at.
static void clip(const polygon *in, int axis, double at, bool keep_low, polygon *out)
{
    out->count = 0;
    for (int i = 0; i < in->count; i++) {
        const double *a = in->p[i], *b = in->p[i + 1 == in->count ? 0 : i + 1];
        bool a_in = keep_low ? a[axis] <= at : a[axis] >= at;
        bool b_in = keep_low ? b[axis] <= at : b[axis] >= at;
        if (a_in) {
            out->p[out->count][0] = a[0];
            out->p[out->count++][1] = a[1];
        }
        if (a_in != b_in && a[axis] != at && b[axis] != at) {
            double s = (at - a[axis]) / (b[axis] - a[axis]);
            out->p[out->count][axis] = at;
            out->p[out->count][1 - axis] = a[1 - axis] + s * (b[1 - axis] - a[1 - axis]);
            out->count++;
        }
    }
}

/// Area and centroid of a convex polygon; all 0 where it has no area.
static double measure(const polygon *shape, double *x, double *y)
{
    double area = 0.0, sx = 0.0, sy = 0.0;
    *x = *y = 0.0;
    const double *o = shape->p[0];
    for (int i = 1; i + 1 < shape->count; i++) {
        double ax = shape->p[i][0] - o[0], ay = shape->p[i][1] - o[1];
        double bx = shape->p[i + 1][0] - o[0], by = shape->p[i + 1][1] - o[1];
        double part = 0.5 * (ax * by - ay * bx);
        area += part;
        sx += part * (ax + bx);
        sy += part * (ay + by);
    }
    if (!(area > 0.0)) {
        return 0.0;
    }
    *x = o[0] + sx / (3.0 * area);
    *y = o[1] + sy / (3.0 * area);
    return area;
}

// --- triangles -----------------------------------------------------------------------------------

/// The texels between `low` and `high`. Coordinates are 32-bit floats: a side that lies on the
/// border between two texels may be off by their spacing, and must not leak across.
static bool texel_range(double low, double high, uint32_t size, uint32_t *first, uint32_t *last)
{
    double margin = fmin(0x1p-23 * size + 1e-7, 0.25 * (high - low));
    double begin = floor(low + margin), end = ceil(high - margin) - 1.0;
    end = fmax(begin, end);
    if (!(end >= 0.0) || !(begin <= (double)size)) {
        return false;
    }
    *first = (uint32_t)fmin(fmax(begin, 0.0), (double)size - 1.0);
    *last = (uint32_t)fmin(fmax(end, 0.0), (double)size - 1.0);
    return true;
}

/// Prepares a triangle; false where it has no area in the page.
static bool set_up(const alp_atlas *atlas, uint32_t triangle, active *a)
{
    double width = atlas->info.width, height = atlas->info.height;
    for (int k = 0; k < 3; k++) {
        a->p[k][0] = (double)atlas->corner_uvs[triangle][k][0] * width;
        a->p[k][1] = (double)atlas->corner_uvs[triangle][k][1] * height;
    }
    double area = 0.5 * ((a->p[1][0] - a->p[0][0]) * (a->p[2][1] - a->p[0][1]) -
                         (a->p[1][1] - a->p[0][1]) * (a->p[2][0] - a->p[0][0]));
    if (area < 0.0) {
        for (int i = 0; i < 2; i++) {
            double swapped = a->p[1][i];
            a->p[1][i] = a->p[2][i];
            a->p[2][i] = swapped;
        }
    }
    vec3 c[3];
    alpi_triangle_corners(atlas->scene, triangle, c);
    a->area = fabs(area);
    a->world_per_texel = vec3_triangle_area(c[0], c[1], c[2]) / a->area;
    a->triangle = triangle;
    double low[2], high[2];
    for (int i = 0; i < 2; i++) {
        low[i] = fmin(a->p[0][i], fmin(a->p[1][i], a->p[2][i]));
        high[i] = fmax(a->p[0][i], fmax(a->p[1][i], a->p[2][i]));
    }
    return a->area > 0.0 &&
           texel_range(low[0], high[0], atlas->info.width, &a->first_column, &a->last_column) &&
           texel_range(low[1], high[1], atlas->info.height, &a->first_row, &a->last_row);
}

/// Least distance of a point from the triangle's edges, negative outside.
static double depth_inside(const active *a, double x, double y)
{
    double depth = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const double *p = a->p[k], *q = a->p[k == 2 ? 0 : k + 1];
        double ex = q[0] - p[0], ey = q[1] - p[1];
        double side = ex * (y - p[1]) - ey * (x - p[0]);
        depth = fmin(depth, side / sqrt(ex * ex + ey * ey));
    }
    return depth;
}

// --- cells ---------------------------------------------------------------------------------------

static void take_receiver(alpi_cell *cell, const active *a, double x, double y, bool center)
{
    cell->triangle = a->triangle;
    cell->x = x;
    cell->y = y;
    cell->center = center;
}

/// Adds a piece of `a` to a cell. The receiver is the centre where it is inside a triangle (of
/// several, the first), else the centroid of the largest piece.
static void add_piece(alpi_cell *cell, const active *a, double area, const double centroid[2],
                      const double center[2])
{
    cell->coverage += area;
    cell->area += area * a->world_per_texel;
    double depth = area >= 1.0 ? 0.5 : depth_inside(a, center[0], center[1]);
    if (depth >= 0.0) {
        bool clash = depth > CENTER_MARGIN && cell->depth > CENTER_MARGIN;
        if (!cell->center || a->triangle < cell->triangle) {
            cell->other = clash ? cell->triangle : cell->other;
            take_receiver(cell, a, center[0], center[1], true);
        } else if (clash) {
            cell->other = a->triangle;
        }
        cell->depth = fmax(cell->depth, depth);
    } else if (!cell->center &&
               (area > cell->piece || (area == cell->piece && a->triangle < cell->triangle))) {
        take_receiver(cell, a, centroid[0], centroid[1], false);
    }
    cell->piece = fmax(cell->piece, area);
    if (cell->coverage > FULL_TEXEL && cell->other == ALPI_NONE) {
        cell->other = a->triangle;
    }
}

/// Adds the part of a triangle inside one texel, if it counts.
static void add_shape(const raster *r, const active *a, const polygon *shape, uint32_t x,
                      uint32_t y)
{
    double centroid[2];
    double area = measure(shape, &centroid[0], &centroid[1]);
    if (area > SMALLEST_PIECE * fmin(1.0, a->area)) {
        const double center[2] = {x + 0.5, y + 0.5};
        add_piece(&r->cells[x], a, fmin(area, 1.0), centroid, center);
    }
}

/// Where a horizontal line cuts the triangle: false = not at all.
static bool cross_section(const active *a, double y, double *left, double *right)
{
    *left = HUGE_VAL;
    *right = -HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const double *p = a->p[k], *q = a->p[k == 2 ? 0 : k + 1];
        if ((p[1] <= y && q[1] >= y) || (q[1] <= y && p[1] >= y)) {
            double s = q[1] != p[1] ? (y - p[1]) / (q[1] - p[1]) : 0.0;
            double x = p[0] + s * (q[0] - p[0]);
            *left = fmin(*left, q[1] != p[1] ? x : fmin(p[0], q[0]));
            *right = fmax(*right, q[1] != p[1] ? x : fmax(p[0], q[0]));
        }
    }
    return *left <= *right;
}

/// The texels [first, end) of a row that lie wholly inside the triangle: those between its cuts
/// with both sides of the row.
static void full_texels(const active *a, uint32_t y, uint32_t *first, uint32_t *end)
{
    double left[2], right[2];
    *first = *end = a->last_column + 1;
    if (cross_section(a, y, &left[0], &right[0]) &&
        cross_section(a, y + 1.0, &left[1], &right[1])) {
        double begin = fmax(ceil(fmax(left[0], left[1])), (double)a->first_column);
        double stop = fmin(floor(fmin(right[0], right[1])), a->last_column + 1.0);
        if (begin < stop) {
            *first = (uint32_t)begin;
            *end = (uint32_t)stop;
        }
    }
}

/// Adds one triangle's share of row y.
static void add_row(const raster *r, const active *a, uint32_t y)
{
    polygon rest = {3,
                    {{a->p[0][0], a->p[0][1]}, {a->p[1][0], a->p[1][1]}, {a->p[2][0], a->p[2][1]}}};
    polygon shape;
    clip(&rest, 1, y, false, &shape);
    clip(&shape, 1, y + 1.0, true, &rest);
    clip(&rest, 0, a->first_column, false, &shape);
    rest = shape;
    uint32_t full_first, full_end;
    full_texels(a, y, &full_first, &full_end);
    for (uint32_t x = a->first_column; x <= a->last_column && rest.count > 2; x++) {
        if (x >= full_first && x < full_end) {
            const double center[2] = {x + 0.5, y + 0.5};
            add_piece(&r->cells[x], a, 1.0, center, center);
            if (x + 1 == full_end) {
                clip(&rest, 0, full_end, false, &shape);
                rest = shape;
            }
            continue;
        }
        polygon inside;
        clip(&rest, 0, x + 1.0, true, &inside);
        clip(&rest, 0, x + 1.0, false, &shape);
        if (inside.count > 2) {
            add_shape(r, a, &inside, x, y);
        }
        rest = shape;
    }
}

// --- pages ---------------------------------------------------------------------------------------

/// Lists the page's triangles that have texels by the row they begin in.
static alp_result list_rows(raster *r, uint32_t page)
{
    const alp_atlas *atlas = r->atlas;
    for (uint32_t y = 0; y < atlas->info.height; y++) {
        r->row_first[y] = ALPI_NONE;
    }
    for (uint32_t t = atlas->scene->triangle_count; t-- > 0;) { // the first comes first in its list
        if (t % TICK_INTERVAL == 0) {
            ALP_TRY(alpi_tick(atlas->context, "texels", page, atlas->info.pages));
        }
        active a;
        if (atlas->triangle_pages[t] == page && atlas->triangle_charts[t] != ALPI_NONE &&
            set_up(atlas, t, &a)) {
            r->next[t] = r->row_first[a.first_row];
            r->row_first[a.first_row] = t;
        }
    }
    return ALP_OK;
}

static alp_result begin_triangles(raster *r, uint32_t y)
{
    for (uint32_t t = r->row_first[y]; t != ALPI_NONE; t = r->next[t]) {
        ALP_TRY(alpi_grow(r->atlas->context, (void **)&r->actives, &r->active_capacity,
                          r->active_count + 1, sizeof *r->actives));
        r->active_count += set_up(r->atlas, t, &r->actives[r->active_count]);
    }
    return ALP_OK;
}

static alp_result finish_row(raster *r, uint32_t page, uint32_t y, alpi_row_fn *finish, void *user)
{
    alpi_row row = {.page = page, .y = y, .first = UINT32_MAX, .last = 0, .cells = r->cells};
    for (size_t i = 0; i < r->active_count; i++) {
        const active *a = &r->actives[i];
        row.first = a->first_column < row.first ? a->first_column : row.first;
        row.last = a->last_column > row.last ? a->last_column : row.last;
    }
    for (uint32_t x = row.first; x <= row.last; x++) {
        r->cells[x] = (alpi_cell){.triangle = ALPI_NONE, .other = ALPI_NONE};
    }
    for (size_t i = 0; i < r->active_count; i++) {
        add_row(r, &r->actives[i], y);
    }
    ALP_TRY(finish(user, &row));
    for (size_t i = 0; i < r->active_count;) {
        if (r->actives[i].last_row == y) {
            r->actives[i] = r->actives[--r->active_count];
        } else {
            i++;
        }
    }
    return ALP_OK;
}

static alp_result raster_pages(raster *r, uint32_t first_page, uint32_t end_page,
                               alpi_row_fn *finish, void *user)
{
    const alp_atlas *atlas = r->atlas;
    ALPI_TRY_NEW(atlas->context, r->row_first, atlas->info.height);
    ALPI_TRY_NEW(atlas->context, r->next, atlas->scene->triangle_count);
    ALPI_TRY_NEW(atlas->context, r->cells, atlas->info.width);
    for (uint32_t page = first_page; page < end_page; page++) {
        ALP_TRY(list_rows(r, page));
        for (uint32_t y = 0; y < atlas->info.height; y++) {
            ALP_TRY(alpi_tick(atlas->context, "texels", (uint64_t)page * atlas->info.height + y,
                              (uint64_t)atlas->info.pages * atlas->info.height));
            ALP_TRY(begin_triangles(r, y));
            if (r->active_count > 0) {
                ALP_TRY(finish_row(r, page, y, finish, user));
            }
        }
    }
    return ALP_OK;
}

alp_result alpi_raster(const alp_atlas *atlas, uint32_t first_page, uint32_t end_page,
                       alpi_row_fn *finish, void *user)
{
    raster r = {.atlas = atlas};
    alp_result result = raster_pages(&r, first_page, end_page, finish, user);
    alpi_release(atlas->context, r.row_first);
    alpi_release(atlas->context, r.next);
    alpi_release(atlas->context, r.actives);
    alpi_release(atlas->context, r.cells);
    return result;
}
