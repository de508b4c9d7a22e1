// SPDX-License-Identifier: MIT
// Clips triangles against the texels of their pages, in bands of rows on all workers: exact areas,
// the pieces of triangles in each texel, and where its centre lies.
#include "atlas/raster.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>

// A piece counts when it is more than this share of a texel, or of its triangle if that is smaller.
static const double SMALLEST_PIECE = 1e-6;
// Triangles that cover more than this share of a texel together must overlap.
static const double FULL_TEXEL = 1.02;
// Where they cover more than this, further pieces are not kept: no list grows without end.
static const double CROWDED_TEXEL = 2.0;
// A centre this far inside two triangles (in texels) is in both, not on the edge between them.
static const double CENTER_MARGIN = 1e-3;

enum {
    CELLS_PER_BAND = 1 << 13, // half a megabyte a worker: they stay in its cache
    LEAST_ROWS = 4,           // a triangle is set up once for every band it reaches
    MOST_ROWS = 64,
    BANDS_OF_PAGE = 32, // at least, of a page of 128 rows or more: else workers wait for the last
    TRIANGLES_PER_RANGE = 1 << 12,
    TICK_INTERVAL = 1 << 16 // triangles between two questions whether to go on
};

static const alpi_cell EMPTY_CELL = {
    .triangle = ALPI_NONE, .other = ALPI_NONE, .first_piece = ALPI_NONE};

/// What a worker keeps from band to band.
typedef struct bench {
    alpi_cell *cells; // [band_rows][width], empty between bands
    alpi_piece *pieces;
    size_t piece_count, piece_capacity;
    uint32_t (*columns)[2]; // [band_rows]
    uint32_t covered;
} bench;

typedef struct raster {
    const alp_atlas *atlas;
    uint32_t first_page, end_page;
    uint32_t band_rows, bands_per_page;
    uint16_t (*bands)[2];     // [triangle_count] first and last of its page; first > last: none
    uint64_t *band_first;     // [bands + 1] in band_triangles
    uint32_t *band_triangles; // in their order
    uint32_t bench_count;
    bench *benches; // [workers]
    alpi_band_fn *finish;
    void *user;
} raster;

/// A triangle at work in a band.
typedef struct active {
    alpi_page_triangle shape;
    double world_per_texel; // m² per texel
    uint32_t first_column, last_column;
} active;

static uint32_t rows_of_band(const alp_atlas *atlas)
{
    uint32_t rows = CELLS_PER_BAND / atlas->info.width;
    rows = rows < atlas->info.height / BANDS_OF_PAGE ? rows : atlas->info.height / BANDS_OF_PAGE;
    rows = rows < LEAST_ROWS ? LEAST_ROWS : rows;
    return rows > MOST_ROWS ? MOST_ROWS : rows;
}

uint32_t alpi_raster_bands(const alp_atlas *atlas)
{
    const uint32_t rows = rows_of_band(atlas);
    return (atlas->info.height + rows - 1) / rows;
}

// --- cells ---------------------------------------------------------------------------------------

/// Least distance of a point from the triangle's edges, negative outside.
static double depth_inside(const active *a, double x, double y)
{
    double depth = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const double *p = a->shape.p[k], *q = a->shape.p[k == 2 ? 0 : k + 1];
        double ex = q[0] - p[0], ey = q[1] - p[1];
        double side = ex * (y - p[1]) - ey * (x - p[0]);
        depth = alpi_lesser(depth, side / sqrt(ex * ex + ey * ey));
    }
    return depth;
}

/// What a triangle has in a texel.
typedef struct part {
    double area, centroid[2]; // texels
    double center[2];         // of the texel
} part;

static void take_receiver(alpi_cell *cell, const active *a, double x, double y, bool center)
{
    cell->triangle = a->shape.triangle;
    cell->x = x;
    cell->y = y;
    cell->center = center;
}

/// Adds a piece of `a` to a cell. The receiver is the centre where it is inside a triangle (of
/// several, the first), else the centroid of the largest piece.
static void judge_piece(alpi_cell *cell, const active *a, const part *p)
{
    const uint32_t triangle = a->shape.triangle;
    const double area = p->area;
    cell->coverage += area;
    cell->area += area * a->world_per_texel;
    double depth = area >= 1.0 ? 0.5 : depth_inside(a, p->center[0], p->center[1]);
    if (depth >= 0.0) {
        bool clash = depth > CENTER_MARGIN && cell->depth > CENTER_MARGIN;
        if (!cell->center || triangle < cell->triangle) {
            cell->other = clash ? cell->triangle : cell->other;
            take_receiver(cell, a, p->center[0], p->center[1], true);
        } else if (clash) {
            cell->other = triangle;
        }
        cell->depth = alpi_greater(cell->depth, depth);
    } else if (!cell->center &&
               (area > cell->piece || (area == cell->piece && triangle < cell->triangle))) {
        take_receiver(cell, a, p->centroid[0], p->centroid[1], false);
    }
    cell->piece = alpi_greater(cell->piece, area);
    if (cell->coverage > FULL_TEXEL && cell->other == ALPI_NONE) {
        cell->other = triangle;
    }
}

static alp_result add_piece(const raster *r, bench *b, alpi_cell *cell, const active *a,
                            const part *p)
{
    if (b->piece_count == b->piece_capacity) {
        ALP_TRY(alpi_grow(r->atlas->context, (void **)&b->pieces, &b->piece_capacity,
                          b->piece_count + 1, sizeof *b->pieces));
    }
    if (cell->coverage <= CROWDED_TEXEL) {
        b->pieces[b->piece_count] = (alpi_piece){.triangle = a->shape.triangle,
                                                 .next = cell->first_piece,
                                                 .area = p->area * a->world_per_texel,
                                                 .x = (float)(p->centroid[0] - p->center[0] + 0.5),
                                                 .y = (float)(p->centroid[1] - p->center[1] + 0.5)};
        b->covered += cell->first_piece == ALPI_NONE;
        cell->first_piece = (uint32_t)b->piece_count++;
    }
    judge_piece(cell, a, p);
    return ALP_OK;
}

/// Adds the part of a triangle inside one texel, if it counts.
static alp_result add_shape(const raster *r, bench *b, alpi_cell *cell, const active *a,
                            const alpi_polygon *shape, const double center[2])
{
    part p = {.center = {center[0], center[1]}};
    double area = shape->count > 2 ? alpi_polygon_measure(shape, p.centroid) : 0.0;
    p.area = alpi_lesser(area, 1.0);
    return area > SMALLEST_PIECE * alpi_lesser(1.0, a->shape.area) ? add_piece(r, b, cell, a, &p)
                                                                   : ALP_OK;
}

// --- triangles -----------------------------------------------------------------------------------

/// Where a horizontal line cuts the triangle: false = not at all.
static bool cross_section(const alpi_page_triangle *a, double y, double *left, double *right)
{
    *left = HUGE_VAL;
    *right = -HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const double *p = a->p[k], *q = a->p[k == 2 ? 0 : k + 1];
        if ((p[1] <= y && q[1] >= y) || (q[1] <= y && p[1] >= y)) {
            double s = q[1] != p[1] ? (y - p[1]) / (q[1] - p[1]) : 0.0;
            double x = p[0] + s * (q[0] - p[0]);
            *left = alpi_lesser(*left, q[1] != p[1] ? x : alpi_lesser(p[0], q[0]));
            *right = alpi_greater(*right, q[1] != p[1] ? x : alpi_greater(p[0], q[0]));
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
    if (cross_section(&a->shape, y, &left[0], &right[0]) &&
        cross_section(&a->shape, y + 1.0, &left[1], &right[1])) {
        double begin = alpi_greater(ceil(alpi_greater(left[0], left[1])), (double)a->first_column);
        double stop = alpi_lesser(floor(alpi_lesser(right[0], right[1])), a->last_column + 1.0);
        if (begin < stop) {
            *first = (uint32_t)begin;
            *end = (uint32_t)stop;
        }
    }
}

/// The part of the triangle in row y, from its first column on.
static void cut_row(const active *a, uint32_t y, alpi_polygon *rest)
{
    const alpi_page_triangle *t = &a->shape;
    alpi_polygon_of_triangle(t, rest);
    if (t->low[1] < y) {
        alpi_polygon_cut(rest, 1, y, false);
    }
    if (t->high[1] > y + 1.0) {
        alpi_polygon_cut(rest, 1, y + 1.0, true);
    }
    if (t->low[0] < a->first_column) {
        alpi_polygon_cut(rest, 0, a->first_column, false);
    }
}

/// Adds one triangle's share of row y.
static alp_result add_row(const raster *r, bench *b, const active *a, uint32_t y, alpi_cell *cells)
{
    alpi_polygon rest;
    cut_row(a, y, &rest);
    uint32_t full_first, full_end;
    full_texels(a, y, &full_first, &full_end);
    for (uint32_t x = a->first_column; x <= a->last_column && rest.count > 2; x++) {
        const double center[2] = {x + 0.5, y + 0.5};
        if (x >= full_first && x < full_end) {
            const part all = {1.0, {center[0], center[1]}, {center[0], center[1]}};
            ALP_TRY(add_piece(r, b, &cells[x], a, &all));
            if (x + 1 == full_end) {
                alpi_polygon_cut(&rest, 0, full_end, false);
            }
            continue;
        }
        if (x == a->last_column && a->shape.high[0] <= x + 1.0) {
            return add_shape(r, b, &cells[x], a, &rest, center);
        }
        alpi_polygon inside;
        alpi_polygon_clip(&rest, 0, x + 1.0, true, &inside);
        ALP_TRY(add_shape(r, b, &cells[x], a, &inside, center));
        alpi_polygon_cut(&rest, 0, x + 1.0, false);
    }
    return ALP_OK;
}

// --- bands ---------------------------------------------------------------------------------------

static alp_result add_triangle(const raster *r, bench *b, uint32_t triangle, uint32_t first_row,
                               uint32_t end_row)
{
    const alp_atlas *atlas = r->atlas;
    active a;
    uint32_t first, last;
    if (!alpi_page_triangle_load(atlas, triangle, &a.shape) ||
        !alpi_page_triangle_range(&a.shape, 0, atlas->info.width, &a.first_column,
                                  &a.last_column) ||
        !alpi_page_triangle_range(&a.shape, 1, atlas->info.height, &first, &last)) {
        return ALP_OK;
    }
    vec3 c[3];
    alpi_triangle_corners(atlas->scene, alpi_atlas_triangle(atlas, triangle), c);
    a.world_per_texel = vec3_triangle_area(c[0], c[1], c[2]) / a.shape.area;
    first = first > first_row ? first : first_row;
    for (uint32_t y = first; y <= last && y < end_row; y++) {
        uint32_t *columns = b->columns[y - first_row];
        columns[0] = a.first_column < columns[0] ? a.first_column : columns[0];
        columns[1] = a.last_column >= columns[1] ? a.last_column + 1 : columns[1];
        ALP_TRY(add_row(r, b, &a, y, b->cells + (size_t)(y - first_row) * atlas->info.width));
    }
    return ALP_OK;
}

static alp_result prepare_bench(const raster *r, bench *b)
{
    const size_t count = (size_t)r->band_rows * r->atlas->info.width;
    if (b->columns == NULL) {
        ALPI_TRY_NEW(r->atlas->context, b->columns, r->band_rows);
    }
    if (b->cells == NULL) {
        ALPI_TRY_NEW(r->atlas->context, b->cells, count);
        for (size_t i = 0; i < count; i++) {
            b->cells[i] = EMPTY_CELL;
        }
    }
    for (uint32_t y = 0; y < r->band_rows; y++) {
        b->columns[y][0] = UINT32_MAX;
        b->columns[y][1] = 0;
    }
    b->piece_count = 0;
    b->covered = 0;
    return ALP_OK;
}

static void clear_cells(const raster *r, const bench *b)
{
    for (uint32_t y = 0; y < r->band_rows; y++) {
        alpi_cell *cells = b->cells + (size_t)y * r->atlas->info.width;
        for (uint32_t x = b->columns[y][0]; x < b->columns[y][1]; x++) {
            if (cells[x].first_piece != ALPI_NONE) {
                cells[x] = EMPTY_CELL;
            }
        }
    }
}

static alp_result draw_band(const raster *r, bench *b, uint32_t index)
{
    const uint32_t first_row = index % r->bands_per_page * r->band_rows;
    const uint32_t left = r->atlas->info.height - first_row;
    const uint32_t end_row = first_row + (left < r->band_rows ? left : r->band_rows);
    for (uint64_t k = r->band_first[index]; k < r->band_first[index + 1]; k++) {
        ALP_TRY(add_triangle(r, b, r->band_triangles[k], first_row, end_row));
    }
    const alpi_band band = {.page = r->first_page + index / r->bands_per_page,
                            .index = index,
                            .first_row = first_row,
                            .end_row = end_row,
                            .width = r->atlas->info.width,
                            .covered = b->covered,
                            .piece_count = (uint32_t)b->piece_count,
                            .columns = (const uint32_t(*)[2])b->columns,
                            .cells = b->cells,
                            .pieces = b->pieces};
    return r->finish(r->user, &band);
}

/// A worker may go on with bands below one that failed, so a failure leaves its bench clean too.
static alp_result run_band(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    const raster *r = user;
    bench *b = &r->benches[worker];
    for (uint32_t i = begin; i < end; i++) {
        if (r->band_first[i] == r->band_first[i + 1]) {
            continue;
        }
        ALP_TRY(prepare_bench(r, b));
        const alp_result result = draw_band(r, b, i);
        clear_cells(r, b);
        ALP_TRY(result);
    }
    return ALP_OK;
}

// --- which triangles are in which band -----------------------------------------------------------

static alp_result find_bands(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const raster *r = user;
    const alp_atlas *atlas = r->atlas;
    for (uint32_t t = begin; t < end; t++) {
        alpi_page_triangle shape;
        uint32_t first, last, row[2];
        const uint32_t page = atlas->triangle_pages[t];
        r->bands[t][0] = 1;
        r->bands[t][1] = 0;
        if (atlas->triangle_charts[t] != ALPI_NONE && page >= r->first_page && page < r->end_page &&
            alpi_page_triangle_load(atlas, t, &shape) &&
            alpi_page_triangle_range(&shape, 0, atlas->info.width, &first, &last) &&
            alpi_page_triangle_range(&shape, 1, atlas->info.height, &row[0], &row[1])) {
            r->bands[t][0] = (uint16_t)(row[0] / r->band_rows);
            r->bands[t][1] = (uint16_t)(row[1] / r->band_rows);
        }
    }
    return ALP_OK;
}

/// Counts (fill false) or lists the triangles of every band; `at` is moved to the bands' ends.
static alp_result list_bands(const raster *r, bool fill, uint64_t *at)
{
    const alp_atlas *atlas = r->atlas;
    for (uint32_t t = 0; t < alpi_atlas_face_count(atlas); t++) {
        if (t % TICK_INTERVAL == 0) {
            ALP_TRY(alpi_tick(atlas->context, "texels", r->first_page, atlas->info.pages));
        }
        const uint32_t first = r->bands[t][0], last = r->bands[t][1];
        for (uint32_t b = first; b <= last; b++) {
            const size_t band =
                (size_t)(atlas->triangle_pages[t] - r->first_page) * r->bands_per_page + b;
            if (fill) {
                r->band_triangles[at[band]] = t;
            }
            at[band]++;
        }
    }
    return ALP_OK;
}

static alp_result sort_into_bands(raster *r, uint32_t band_count)
{
    alp_context *context = r->atlas->context;
    ALPI_TRY_NEW(context, r->bands, alpi_atlas_face_count(r->atlas));
    ALPI_TRY_NEW(context, r->band_first, (size_t)band_count + 1);
    ALP_TRY(alpi_parallel_for(context, alpi_atlas_face_count(r->atlas), TRIANGLES_PER_RANGE,
                              find_bands, r, NULL));
    ALP_TRY(list_bands(r, false, r->band_first + 1));
    for (uint32_t i = 0; i < band_count; i++) {
        r->band_first[i + 1] += r->band_first[i];
    }
    ALPI_TRY_NEW(context, r->band_triangles, r->band_first[band_count]);
    // Filling moves each band's beginning to its end, which is where the next begins.
    ALP_TRY(list_bands(r, true, r->band_first));
    for (uint32_t i = band_count; i > 0; i--) {
        r->band_first[i] = r->band_first[i - 1];
    }
    r->band_first[0] = 0;
    alpi_release(context, r->bands);
    r->bands = NULL;
    return ALP_OK;
}

static alp_result run_raster(raster *r)
{
    alp_context *context = r->atlas->context;
    const uint32_t pages = r->end_page - r->first_page;
    if ((uint64_t)pages * r->bands_per_page > UINT32_MAX - 1) {
        return alpi_fail(context, ALP_ERROR_LIMIT, "%s: %u pages of %u rows are too many",
                         r->atlas->scene->name, pages, r->atlas->info.height);
    }
    const uint32_t band_count = pages * r->bands_per_page;
    r->bench_count = alp_context_worker_count(context);
    ALPI_TRY_NEW(context, r->benches, r->bench_count);
    ALP_TRY(sort_into_bands(r, band_count));
    const alpi_watch *watch = alpi_context_watch(context);
    const alpi_task_progress progress = {
        .callback = watch->callback, .user = watch->user, .stage = "texels"};
    return alpi_parallel_for(context, band_count, 1, run_band, r, &progress);
}

alp_result alpi_raster(const alp_atlas *atlas, uint32_t first_page, uint32_t end_page,
                       alpi_band_fn *finish, void *user)
{
    raster r = {.atlas = atlas,
                .first_page = first_page,
                .end_page = end_page,
                .band_rows = rows_of_band(atlas),
                .bands_per_page = alpi_raster_bands(atlas),
                .finish = finish,
                .user = user};
    alp_result result = run_raster(&r);
    for (uint32_t i = 0; r.benches != NULL && i < r.bench_count; i++) {
        alpi_release(atlas->context, r.benches[i].cells);
        alpi_release(atlas->context, r.benches[i].pieces);
        alpi_release(atlas->context, r.benches[i].columns);
    }
    alpi_release(atlas->context, r.benches);
    alpi_release(atlas->context, r.bands);
    alpi_release(atlas->context, r.band_first);
    alpi_release(atlas->context, r.band_triangles);
    return result;
}
