// SPDX-License-Identifier: MIT
// Whether triangles of a plane overlap: separating axes, and a grid that finds the candidates.
#include "atlas/fold.h"

#include "base/memory.h"

#include <math.h>

// Overlap below this share of the triangles' extent is rounding: a hundredth of a texel on the
// largest page.
static const double RELATIVE_TOLERANCE = 5e-7;

/// Whether an edge of `a` has all of `b` on its outer side (or within the tolerance of it).
static bool is_separated(const alpi_flat *a, const alpi_flat *b, double tolerance)
{
    for (int k = 0; k < 3; k++) {
        int next = k == 2 ? 0 : k + 1;
        double px = a->x[k], py = a->y[k];
        double ex = a->x[next] - px, ey = a->y[next] - py;
        double inside = -HUGE_VAL;
        for (int i = 0; i < 3; i++) {
            inside = fmax(inside, ex * (b->y[i] - py) - ey * (b->x[i] - px));
        }
        if (inside <= 0.0 || inside * inside <= tolerance * tolerance * (ex * ex + ey * ey)) {
            return true;
        }
    }
    return false;
}

bool alpi_flat_overlap(const alpi_flat *a, const alpi_flat *b, double tolerance)
{
    return !is_separated(a, b, tolerance) && !is_separated(b, a, tolerance);
}

static double min3(const double v[3])
{
    return fmin(v[0], fmin(v[1], v[2]));
}

static double max3(const double v[3])
{
    return fmax(v[0], fmax(v[1], v[2]));
}

static uint32_t cell_of(double offset, double cell, uint32_t count)
{
    double index = floor(offset / cell);
    return index <= 0.0 ? 0 : index >= (double)count ? count - 1 : (uint32_t)index;
}

/// The cells [first, last] of one grid row that a triangle may touch; false = none.
static bool row_range(const alpi_fold *fold, const alpi_flat *t, uint32_t row, uint32_t *first,
                      uint32_t *last)
{
    double low = fold->low_y + row * fold->cell, high = low + fold->cell;
    // The outermost rows and a little more than each row: rounding must lose nothing.
    low = row == 0 ? -(double)INFINITY : low - 1e-9 * fold->cell;
    high = row + 1 == fold->rows ? (double)INFINITY : high + 1e-9 * fold->cell;
    double left = HUGE_VAL, right = -HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        int next = k == 2 ? 0 : k + 1;
        double x0 = t->x[k], y0 = t->y[k], x1 = t->x[next], y1 = t->y[next];
        if (fmax(y0, y1) < low || fmin(y0, y1) > high) {
            continue;
        }
        double slope = y1 != y0 ? (x1 - x0) / (y1 - y0) : 0.0;
        double a = y0 < low ? x0 + slope * (low - y0) : y0 > high ? x0 + slope * (high - y0) : x0;
        double b = y1 < low ? x0 + slope * (low - y0) : y1 > high ? x0 + slope * (high - y0) : x1;
        left = fmin(left, fmin(a, b));
        right = fmax(right, fmax(a, b));
    }
    if (left > right) {
        return false;
    }
    double margin = 1e-9 * fold->cell;
    *first = cell_of(left - fold->low_x - margin, fold->cell, fold->columns);
    *last = cell_of(right - fold->low_x + margin, fold->cell, fold->columns);
    return true;
}

/// Calls for every cell of a triangle: counts it, or puts it in the cell's list.
static size_t visit_cells(alpi_fold *fold, uint32_t triangle, bool store)
{
    const alpi_flat *t = &fold->triangles[triangle];
    uint32_t top = cell_of(min3(t->y) - fold->low_y, fold->cell, fold->rows);
    uint32_t bottom = cell_of(max3(t->y) - fold->low_y, fold->cell, fold->rows);
    top = top > 0 ? top - 1 : 0;
    bottom = bottom + 1 < fold->rows ? bottom + 1 : bottom;
    size_t cells = 0;
    for (uint32_t row = top; row <= bottom; row++) {
        uint32_t first, last;
        if (!row_range(fold, t, row, &first, &last)) {
            continue;
        }
        cells += last - first + 1;
        for (uint32_t column = first; column <= last; column++) {
            uint32_t *slot = &fold->first[(size_t)row * fold->columns + column];
            if (store) {
                fold->items[--*slot] = triangle;
            } else {
                ++*slot;
            }
        }
    }
    return cells;
}

/// Bounds, tolerance and a grid of about `wanted` cells.
static void choose_grid(alpi_fold *fold, double wanted)
{
    double low_x = HUGE_VAL, low_y = HUGE_VAL, high_x = -HUGE_VAL, high_y = -HUGE_VAL;
    for (uint32_t i = 0; i < fold->count; i++) {
        low_x = fmin(low_x, min3(fold->triangles[i].x));
        low_y = fmin(low_y, min3(fold->triangles[i].y));
        high_x = fmax(high_x, max3(fold->triangles[i].x));
        high_y = fmax(high_y, max3(fold->triangles[i].y));
    }
    double width = high_x - low_x, height = high_y - low_y;
    double longest = fmax(fmax(width, height), 1e-300);
    fold->low_x = low_x;
    fold->low_y = low_y;
    fold->tolerance = RELATIVE_TOLERANCE * longest;
    fold->cell = fmax(sqrt(width * height / wanted), longest / wanted);
    fold->columns = (uint32_t)fmin(floor(width / fold->cell) + 1.0, wanted + 1.0);
    fold->rows = (uint32_t)fmin(floor(height / fold->cell) + 1.0, wanted + 1.0);
}

alp_result alpi_fold_build(alpi_fold *fold, const alpi_flat *triangles, uint32_t count)
{
    fold->triangles = triangles;
    fold->count = count;
    // Needles touch many cells: then a coarser grid, so that the lists stay linear in the
    // triangles.
    size_t limit = 16 * (size_t)count + 256, used = 0;
    for (double wanted = count;; wanted *= 0.25) {
        choose_grid(fold, fmax(wanted, 1.0));
        size_t cells = (size_t)fold->columns * fold->rows;
        ALP_TRY(alpi_grow(fold->context, (void **)&fold->first, &fold->first_capacity, cells + 1,
                          sizeof *fold->first));
        for (size_t i = 0; i <= cells; i++) {
            fold->first[i] = 0;
        }
        used = 0;
        for (uint32_t i = 0; i < count && used <= limit; i++) {
            used += visit_cells(fold, i, false);
        }
        if (used <= limit || wanted <= 1.0) {
            break;
        }
    }
    ALP_TRY(alpi_grow(fold->context, (void **)&fold->items, &fold->item_capacity, used + 1,
                      sizeof *fold->items));
    size_t cells = (size_t)fold->columns * fold->rows;
    for (size_t i = 1; i <= cells; i++) {
        fold->first[i] += fold->first[i - 1];
    }
    for (uint32_t i = 0; i < count; i++) { // each list's end moves back to its beginning
        visit_cells(fold, i, true);
    }
    return ALP_OK;
}

static bool boxes_touch(const alpi_flat *a, const alpi_flat *b)
{
    return min3(a->x) < max3(b->x) && min3(b->x) < max3(a->x) && min3(a->y) < max3(b->y) &&
           min3(b->y) < max3(a->y);
}

bool alpi_fold_overlaps(const alpi_fold *fold, uint32_t triangle, const bool *marked)
{
    const alpi_flat *t = &fold->triangles[triangle];
    uint32_t top = cell_of(min3(t->y) - fold->low_y, fold->cell, fold->rows);
    uint32_t bottom = cell_of(max3(t->y) - fold->low_y, fold->cell, fold->rows);
    for (uint32_t row = top; row <= bottom; row++) {
        uint32_t first, last;
        if (!row_range(fold, t, row, &first, &last)) {
            continue;
        }
        const uint32_t *lists = &fold->first[(size_t)row * fold->columns];
        for (uint32_t i = lists[first]; i < lists[last + 1]; i++) {
            uint32_t other = fold->items[i];
            if (marked[other] && other != triangle && boxes_touch(t, &fold->triangles[other]) &&
                alpi_flat_overlap(t, &fold->triangles[other], fold->tolerance)) {
                return true;
            }
        }
    }
    return false;
}

void alpi_fold_destroy(alpi_fold *fold)
{
    alpi_release(fold->context, fold->first);
    alpi_release(fold->context, fold->items);
    *fold = (alpi_fold){0};
}
