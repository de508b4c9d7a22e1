// SPDX-License-Identifier: MIT
// Charts larger than a page, or than a part of one, are cut: into strips as wide as a part, these
// into pieces as high, from the lowest triangle on, so that most pieces fill their part and what is
// left over is narrow and goes into holes. Pieces are connected, and one that stays small goes to a
// neighbour that has room for it in its part.
#include "atlas/box.h"
#include "atlas/factors.h"
#include "atlas/stages.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// From where to where a triangle reaches along an axis.
typedef struct span {
    double low, high;
    uint32_t triangle;
} span;

typedef struct piece {
    double low[2], high[2];
    uint32_t count, first;
    uint32_t joined; // the piece that it went to, itself: none
} piece;

/// Two pieces that meet.
typedef struct border {
    uint32_t low, high; // low < high
    double length;
} border;

typedef struct cutter {
    alp_atlas *atlas;
    const uint32_t (*neighbours)[3];
    alpi_charts *charts;
    alpi_cut_sides sides;
    uint32_t chart;       // that is being cut
    double slack;         // of it
    span *spans[2];       // [triangles of the largest chart] of all, of a strip
    span *kept;           // [the same] scratch
    uint32_t *order;      // [the same] scratch
    uint32_t *labels;     // [triangle_count] what must not be mixed; then the piece
    uint32_t *roots;      // [triangle_count] union-find
    uint32_t label_count; // of the chart
    piece *pieces;
    size_t piece_capacity;
    uint32_t piece_count;
    border *borders;
    size_t border_capacity;
    uint32_t border_count;
} cutter;

// --- triangles larger than a page ----------------------------------------------------------------

static void load_points(const alp_atlas *atlas, uint32_t triangle, alpi_point points[3])
{
    for (int k = 0; k < 3; k++) {
        const float *uv = atlas->corner_uvs[triangle][k];
        points[k] = (alpi_point){(double)uv[0], (double)uv[1]};
    }
}

static double square_side(const alp_atlas *atlas, uint32_t triangle)
{
    alpi_point points[3];
    load_points(atlas, triangle, points);
    const alpi_box box = alpi_smallest_square(points);
    return fmax(box.width, box.height);
}

static alp_result fail_too_large(const alp_atlas *atlas, uint32_t triangle, double side,
                                 double density)
{
    const alpi_surface *surface = &atlas->scene->surfaces[atlas->scene->triangle_surface[triangle]];
    const double factor = alpi_factor_of(atlas, triangle);
    const double most = 0.999 * atlas->options.size / side, texels = ceil(1.001 * side * density);
    char *larger = texels <= ALPI_ATLAS_SIZE_LIMIT
                       ? alpi_format(atlas->context, "a page of %.0f texels", texels)
                       : alpi_format(atlas->context, "a finer mesh");
    if (larger == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result = alpi_fail(
        atlas->context, ALP_ERROR_LIMIT,
        "%s: %s: triangle %u needs a square of %.4g m: at %.4g texels per metre it is larger than "
        "a page of %u texels; use at most %.4g texels per metre or %s",
        atlas->scene->name, surface->name, triangle - surface->first_triangle, side / factor,
        density * factor, atlas->options.size, most, larger);
    alpi_release(atlas->context, larger);
    return result;
}

alp_result alpi_charts_check(const alp_atlas *atlas, double density, const alpi_charts *charts)
{
    const double limit = alpi_part_side(atlas->options.size, density);
    double most = limit;
    uint32_t largest = ALPI_NONE;
    for (uint32_t c = 0; c < charts->count; c++) {
        const alpi_chart *chart = &charts->charts[c];
        const bool fits = fmax(chart->width, chart->height) <= limit;
        const double slack = alpi_cut_slack(chart, 1.0 / density);
        for (uint32_t i = chart->first; i < chart->first + chart->count && !fits; i++) {
            const double side = square_side(atlas, charts->triangles[i]);
            largest = side > most + slack ? charts->triangles[i] : largest;
            most = side > most + slack ? side : most;
        }
    }
    return largest == ALPI_NONE ? ALP_OK : fail_too_large(atlas, largest, most, density);
}

// --- strips and cells ----------------------------------------------------------------------------

static span span_of(const alp_atlas *atlas, uint32_t triangle, int axis)
{
    const float(*uv)[2] = (const float(*)[2])atlas->corner_uvs[triangle];
    const double a = (double)uv[0][axis], b = (double)uv[1][axis], c = (double)uv[2][axis];
    return (span){fmin(a, fmin(b, c)), fmax(a, fmax(b, c)), triangle};
}

static int compare_spans(const void *a, const void *b)
{
    const span *s = a, *t = b;
    if (s->low != t->low) {
        return s->low < t->low ? -1 : 1;
    }
    return s->triangle < t->triangle ? -1 : s->triangle > t->triangle;
}

/// Of spans sorted by their lower ends, moves those to the front that end within a part of the
/// first one's beginning; how many. The others stay in order.
static uint32_t take_part(const cutter *c, span *spans, uint32_t count)
{
    const double end = spans[0].low + c->sides.part + c->slack;
    uint32_t taken = 0, kept = 0, i = 0;
    for (; i < count && spans[i].low <= end; i++) {
        if (i == 0 || spans[i].high <= end) { // the first whatever sums round to
            spans[taken++] = spans[i];
        } else {
            c->kept[kept++] = spans[i];
        }
    }
    memcpy(spans + taken, c->kept, kept * sizeof *spans);
    return taken;
}

/// Labels the triangles of a strip by cells.
static void label_strip(cutter *c, uint32_t count, const span *strip)
{
    span *spans = c->spans[1];
    for (uint32_t i = 0; i < count; i++) {
        spans[i] = span_of(c->atlas, strip[i].triangle, 1);
    }
    qsort(spans, count, sizeof *spans, compare_spans);
    for (uint32_t begin = 0, taken; begin < count; begin += taken) {
        taken = take_part(c, spans + begin, count - begin);
        for (uint32_t i = begin; i < begin + taken; i++) {
            c->labels[spans[i].triangle] = c->label_count;
        }
        c->label_count++;
    }
}

/// Labels the triangles of the chart by the cell that holds them; those that none holds get labels
/// of their own.
static void label_cells(cutter *c)
{
    const alpi_chart *chart = &c->charts->charts[c->chart];
    span *spans = c->spans[0];
    uint32_t count = 0;
    c->label_count = 0;
    for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
        const uint32_t t = c->charts->triangles[i];
        const span x = span_of(c->atlas, t, 0), y = span_of(c->atlas, t, 1);
        if (fmax(x.high - x.low, y.high - y.low) <= c->sides.part + c->slack) {
            spans[count++] = x;
        } else {
            c->labels[t] = c->label_count++;
        }
    }
    qsort(spans, count, sizeof *spans, compare_spans);
    for (uint32_t begin = 0, taken; begin < count; begin += taken) {
        taken = take_part(c, spans + begin, count - begin);
        label_strip(c, taken, spans + begin);
    }
}

// --- connected pieces ----------------------------------------------------------------------------

/// Whether edge k of a triangle lies in the chart where an edge of its neighbour does: charts are
/// cut open along edges too.
static bool is_joined(const cutter *c, uint32_t triangle, int k, uint32_t across)
{
    const float(*p)[2] = (const float(*)[2])c->atlas->corner_uvs[triangle];
    const float(*q)[2] = (const float(*)[2])c->atlas->corner_uvs[across];
    const int next = k == 2 ? 0 : k + 1;
    const alpi_chart *chart = &c->charts->charts[c->chart];
    const double length =
        fabs((double)p[next][0] - (double)p[k][0]) + fabs((double)p[next][1] - (double)p[k][1]);
    const double near = 0.01 * length + 1e-6 * fmax(chart->width, chart->height); // rounding
    for (int j = 0; j < 3; j++) {
        const int end = j == 2 ? 0 : j + 1;
        double off = 0.0;
        for (int i = 0; i < 2; i++) {
            off = fmax(off, fabs((double)p[k][i] - (double)q[end][i]));
            off = fmax(off, fabs((double)p[next][i] - (double)q[j][i]));
        }
        if (c->neighbours[across][j] == triangle && off <= near) {
            return true;
        }
    }
    return false;
}

/// The neighbour across edge k in the chart, or ALPI_NONE.
static uint32_t across_edge(const cutter *c, uint32_t triangle, int k)
{
    const uint32_t across = c->neighbours[triangle][k];
    return across != ALPI_NONE && c->atlas->triangle_charts[across] == c->chart &&
                   is_joined(c, triangle, k, across)
               ? across
               : ALPI_NONE;
}

static uint32_t root_of(uint32_t *roots, uint32_t i)
{
    while (roots[i] != i) {
        roots[i] = roots[roots[i]];
        i = roots[i];
    }
    return i;
}

/// Joins what is connected within a label.
static void connect(cutter *c, const uint32_t *triangles, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        c->roots[triangles[i]] = triangles[i];
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t t = triangles[i];
        for (int k = 0; k < 3; k++) {
            const uint32_t across = across_edge(c, t, k);
            if (across != ALPI_NONE && c->labels[across] == c->labels[t]) {
                const uint32_t a = root_of(c->roots, t), b = root_of(c->roots, across);
                c->roots[a > b ? a : b] = a < b ? a : b;
            }
        }
    }
}

static void widen_piece(const cutter *c, piece *to, uint32_t triangle)
{
    for (int axis = 0; axis < 2; axis++) {
        const span s = span_of(c->atlas, triangle, axis);
        to->low[axis] = to->count == 0 ? s.low : fmin(to->low[axis], s.low);
        to->high[axis] = to->count == 0 ? s.high : fmax(to->high[axis], s.high);
    }
    to->count++;
}

/// Numbers the connected parts of labels, in the order of their first triangles.
static alp_result list_pieces(cutter *c, const uint32_t *triangles, uint32_t count)
{
    c->piece_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        c->labels[triangles[i]] = ALPI_NONE;
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t root = root_of(c->roots, triangles[i]);
        if (c->labels[root] == ALPI_NONE) {
            ALP_TRY(alpi_grow(c->atlas->context, (void **)&c->pieces, &c->piece_capacity,
                              (size_t)c->piece_count + 1, sizeof *c->pieces));
            c->pieces[c->piece_count] = (piece){.joined = c->piece_count};
            c->labels[root] = c->piece_count++;
        }
        c->labels[triangles[i]] = c->labels[root];
        widen_piece(c, &c->pieces[c->labels[root]], triangles[i]);
    }
    return ALP_OK;
}

// --- small pieces --------------------------------------------------------------------------------

static int compare_pairs(const void *a, const void *b)
{
    const border *s = a, *t = b;
    if (s->low != t->low) {
        return s->low < t->low ? -1 : 1;
    }
    return s->high < t->high ? -1 : s->high > t->high;
}

static int compare_lengths(const void *a, const void *b)
{
    const border *s = a, *t = b;
    return s->length != t->length ? (s->length > t->length ? -1 : 1) : compare_pairs(a, b);
}

/// One entry for each two pieces that meet, the longest border first.
static alp_result list_borders(cutter *c, const uint32_t *triangles, uint32_t count)
{
    uint32_t found = 0;
    c->border_count = 0;
    for (uint32_t i = 0; i < 3 * count; i++) {
        const uint32_t t = triangles[i / 3], k = i % 3, across = across_edge(c, t, (int)k);
        if (across == ALPI_NONE || c->labels[t] >= c->labels[across]) {
            continue;
        }
        const float *p = c->atlas->corner_uvs[t][k], *q = c->atlas->corner_uvs[t][(k + 1) % 3];
        const double x = (double)q[0] - (double)p[0], y = (double)q[1] - (double)p[1];
        ALP_TRY(alpi_grow(c->atlas->context, (void **)&c->borders, &c->border_capacity,
                          (size_t)found + 1, sizeof *c->borders));
        c->borders[found++] = (border){c->labels[t], c->labels[across], sqrt(x * x + y * y)};
    }
    if (found > 0) { // no array else
        qsort(c->borders, found, sizeof *c->borders, compare_pairs);
    }
    for (uint32_t i = 0; i < found; i++) {
        if (c->border_count > 0 &&
            compare_pairs(&c->borders[c->border_count - 1], &c->borders[i]) == 0) {
            c->borders[c->border_count - 1].length += c->borders[i].length;
        } else {
            c->borders[c->border_count++] = c->borders[i];
        }
    }
    if (found > 0) {
        qsort(c->borders, c->border_count, sizeof *c->borders, compare_lengths);
    }
    return ALP_OK;
}

static uint32_t piece_of(const cutter *c, uint32_t i)
{
    while (c->pieces[i].joined != i) {
        i = c->pieces[i].joined = c->pieces[c->pieces[i].joined].joined;
    }
    return i;
}

/// Joins pieces that meet and have a common box within a part.
static void join_pieces(const cutter *c)
{
    for (uint32_t i = 0; i < c->border_count; i++) {
        const uint32_t a = piece_of(c, c->borders[i].low), b = piece_of(c, c->borders[i].high);
        piece *to = &c->pieces[a < b ? a : b], *from = &c->pieces[a < b ? b : a];
        piece both = *to;
        bool fits = a != b;
        for (int axis = 0; axis < 2; axis++) {
            both.low[axis] = fmin(to->low[axis], from->low[axis]);
            both.high[axis] = fmax(to->high[axis], from->high[axis]);
            fits = fits && both.high[axis] - both.low[axis] <= c->sides.part + c->slack;
        }
        if (fits) {
            both.count += from->count;
            from->count = 0;
            from->joined = to->joined;
            *to = both;
        }
    }
}

// --- charts of pieces ----------------------------------------------------------------------------

/// Groups the chart's triangles by pieces, in their order.
static void group_pieces(const cutter *c, uint32_t *triangles, uint32_t count)
{
    uint32_t first = 0;
    for (uint32_t i = 0; i < c->piece_count; i++) {
        c->pieces[i].first = first;
        first += c->pieces[i].count;
        c->pieces[i].count = 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        piece *to = &c->pieces[piece_of(c, c->labels[triangles[i]])];
        c->order[to->first + to->count++] = triangles[i];
    }
    memcpy(triangles, c->order, count * sizeof *triangles);
}

/// A triangle larger than a part lies on its longest edge, where a page is that long: of those that
/// are halves of squares four make a square again, with less of the page left over than two.
static alpi_box box_of_triangle(const cutter *c, uint32_t triangle)
{
    alpi_point points[3];
    load_points(c->atlas, triangle, points);
    const alpi_box box = alpi_lowest_box(points);
    return fmax(box.width, box.height) <= c->sides.page + c->slack ? box
                                                                   : alpi_smallest_square(points);
}

/// Moves a piece's box to the origin; what reaches too far as it lies in its chart is one triangle.
static void make_chart(const cutter *c, const piece *from, alpi_chart *chart)
{
    const uint32_t *triangles = c->charts->triangles + chart->first;
    alpi_box box = {.axis = {1.0, 0.0},
                    .low_x = from->low[0],
                    .low_y = from->low[1],
                    .width = from->high[0] - from->low[0],
                    .height = from->high[1] - from->low[1]};
    double most = c->sides.part;
    if (fmax(box.width, box.height) > most + c->slack) {
        box = box_of_triangle(c, triangles[0]);
        most = c->sides.page;
    }
    box.width = fmin(box.width, most);
    box.height = fmin(box.height, most);
    for (uint32_t i = 0; i < 3 * chart->count; i++) {
        float *uv = c->atlas->corner_uvs[triangles[i / 3]][i % 3];
        const double u = (double)uv[0], v = (double)uv[1];
        const double x = box.axis.x * u + box.axis.y * v - box.low_x;
        const double y = box.axis.x * v - box.axis.y * u - box.low_y;
        uv[0] = (float)fmin(fmax(x, 0.0), box.width);
        uv[1] = (float)fmin(fmax(y, 0.0), box.height);
    }
    chart->width = box.width;
    chart->height = box.height;
}

/// The first piece takes the chart's place, the others go to the end of the list.
static alp_result make_charts(cutter *c)
{
    alpi_charts *charts = c->charts;
    const uint32_t first = charts->charts[c->chart].first;
    ALP_TRY(alpi_grow(c->atlas->context, (void **)&charts->charts, &charts->capacity,
                      (size_t)charts->count + c->piece_count, sizeof *charts->charts));
    for (uint32_t p = 0; p < c->piece_count; p++) {
        const piece *from = &c->pieces[p];
        if (from->count == 0) {
            continue; // joined; the first piece never is
        }
        const uint32_t to = p == 0 ? c->chart : charts->count++;
        charts->charts[to] = (alpi_chart){.first = first + from->first, .count = from->count};
        make_chart(c, from, &charts->charts[to]);
        for (uint32_t i = 0; i < from->count; i++) {
            c->atlas->triangle_charts[charts->triangles[first + from->first + i]] = to;
        }
    }
    return ALP_OK;
}

static alp_result cut_chart(cutter *c)
{
    const alpi_chart *chart = &c->charts->charts[c->chart];
    uint32_t *triangles = c->charts->triangles + chart->first;
    c->slack = alpi_cut_slack(chart, c->sides.texel);
    label_cells(c);
    connect(c, triangles, chart->count);
    ALP_TRY(list_pieces(c, triangles, chart->count));
    ALP_TRY(list_borders(c, triangles, chart->count));
    join_pieces(c);
    group_pieces(c, triangles, chart->count);
    return make_charts(c);
}

static alp_result cut_all(cutter *c)
{
    alp_context *context = c->atlas->context;
    uint32_t largest = 0;
    for (uint32_t i = 0; i < c->charts->count; i++) {
        const alpi_chart *chart = &c->charts->charts[i];
        const bool is_cut = fmax(chart->width, chart->height) > c->sides.limit;
        largest = is_cut && chart->count > largest ? chart->count : largest;
    }
    if (largest == 0) {
        return ALP_OK;
    }
    for (int axis = 0; axis < 2; axis++) {
        ALPI_TRY_NEW(context, c->spans[axis], largest);
    }
    ALPI_TRY_NEW(context, c->kept, largest);
    ALPI_TRY_NEW(context, c->order, largest);
    ALPI_TRY_NEW(context, c->labels, c->atlas->scene->triangle_count);
    ALPI_TRY_NEW(context, c->roots, c->atlas->scene->triangle_count);
    for (const uint32_t count = c->charts->count; c->chart < count; c->chart++) {
        const alpi_chart *chart = &c->charts->charts[c->chart];
        if (fmax(chart->width, chart->height) > c->sides.limit) {
            ALP_TRY(cut_chart(c));
        }
    }
    return ALP_OK;
}

alp_result alpi_charts_cut(alp_atlas *atlas, const uint32_t (*neighbours)[3],
                           const alpi_cut_sides *sides, alpi_charts *charts)
{
    cutter c = {.atlas = atlas, .neighbours = neighbours, .charts = charts, .sides = *sides};
    const alp_result result = cut_all(&c);
    alpi_release(atlas->context, c.spans[0]);
    alpi_release(atlas->context, c.spans[1]);
    alpi_release(atlas->context, c.kept);
    alpi_release(atlas->context, c.order);
    alpi_release(atlas->context, c.labels);
    alpi_release(atlas->context, c.roots);
    alpi_release(atlas->context, c.pieces);
    alpi_release(atlas->context, c.borders);
    return result;
}
