// SPDX-License-Identifier: MIT
// From cells to texels: the representative point of each, and its pieces in an order in which
// neighbours follow each other.
#include "atlas/facet.h"
#include "atlas/stages.h"

#include "base/memory.h"

#include <math.h>

/// What all texels of one triangle share: neighbouring texels mostly lie on the same one.
typedef struct carrier {
    uint32_t triangle;
    alpi_facet_patch map; // from the page's corner
    double edges[2][2],
        heights[3]; // from corner 0; of the corners above the edges opposite; texels
    alpi_facet facet;
} carrier;

static double length(double x, double y)
{
    return sqrt(x * x + y * y); // hypot is slow, and texels are neither tiny nor huge
}

static void load_carrier(const alp_atlas *atlas, uint32_t triangle, carrier *c)
{
    alpi_page_triangle shape;
    alpi_page_triangle_load(atlas, triangle, &shape); // it has area: it has a piece in a texel
    c->triangle = triangle;
    c->map = alpi_page_triangle_patch(&shape, 0.0, 0.0);
    double(*e)[2] = c->edges;
    for (int k = 0; k < 2; k++) {
        const double *end = shape.p[shape.turned ? 2 - k : k + 1];
        e[k][0] = end[0] - shape.p[0][0];
        e[k][1] = end[1] - shape.p[0][1];
    }
    c->heights[0] = 2.0 * shape.area / length(e[1][0] - e[0][0], e[1][1] - e[0][1]);
    c->heights[1] = 2.0 * shape.area / length(e[1][0], e[1][1]);
    c->heights[2] = 2.0 * shape.area / length(e[0][0], e[0][1]);
    alpi_facet_load(atlas->scene, alpi_atlas_triangle(atlas, triangle), false, &c->facet);
}

/// Moves a point that lies on an edge, or nearly, into the triangle: a twentieth of a texel towards
/// its centroid. What stands on a surface often stands on its edges, and modelled on a grid both
/// run through texel centres: a ray that starts a hair above such a point starts inside of what
/// stands there. (A sphere that rests on the diagonal of a square: .97 at the point of contact,
/// instead of 0.)
static void leave_edges(const carrier *c, double b[2])
{
    const double margin = 0.05; // texels; costs as much of the gradient, far below the noise
    const double weights[3] = {1.0 - b[0] - b[1], b[0], b[1]};
    double nearest = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        nearest = alpi_lesser(nearest, weights[k] * c->heights[k]);
    }
    if (nearest >= margin) {
        return;
    }
    const double to[2] = {1.0 / 3.0 - b[0], 1.0 / 3.0 - b[1]};
    double way = length(to[0] * c->edges[0][0] + to[1] * c->edges[1][0],
                        to[0] * c->edges[0][1] + to[1] * c->edges[1][1]);
    double share = way > margin ? margin / way : 1.0;
    b[0] += share * to[0];
    b[1] += share * to[1];
}

/// Barycentrics of corners 1 and 2 at a point in texels, held inside the triangle.
static void find_barycentrics(const carrier *c, double x, double y, double b[2])
{
    for (int k = 0; k < 2; k++) {
        b[k] = c->map.at[k] + x * c->map.by_x[k] + y * c->map.by_y[k];
        b[k] = alpi_lesser(alpi_greater(b[k], 0.0), 1.0);
    }
    double sum = b[0] + b[1];
    if (sum > 1.0) {
        b[0] /= sum;
        b[1] /= sum;
    }
    leave_edges(c, b);
}

// --- pieces --------------------------------------------------------------------------------------

enum { ORDER_CELLS = 64 };

/// Number of a point's cell in the 8 × 8 grid of a texel along a Hilbert curve.
/// Based on: D. Hilbert. Ueber die stetige Abbildung einer Linie auf ein Flächenstück. 1891.
static uint32_t cell_of_point(float x, float y)
{
    int32_t i = (int32_t)(8.0f * x), j = (int32_t)(8.0f * y);
    i = i < 0 ? 0 : i > 7 ? 7 : i;
    j = j < 0 ? 0 : j > 7 ? 7 : j;
    uint32_t index = 0;
    for (int32_t side = 4; side > 0; side /= 2) {
        const int32_t right = (i & side) != 0, upper = (j & side) != 0;
        index = 4 * index + (uint32_t)((3 * right) ^ upper);
        if (!upper) { // the quarter's own curve is turned
            const int32_t kept = right ? 7 - i : i;
            i = right ? 7 - j : j;
            j = kept;
        }
    }
    return index;
}

/// Writes the pieces of a cell, sorted along the curve (counting, so linear), to the end of a
/// chunk.
/// @return how many
static uint32_t write_pieces(const alpi_band *band, const alpi_cell *cell, alpi_texel_chunk *chunk)
{
    uint32_t first[ORDER_CELLS + 1] = {0};
    const alpi_piece *pieces = band->pieces;
    for (uint32_t p = cell->first_piece; p != ALPI_NONE; p = pieces[p].next) {
        first[cell_of_point(pieces[p].x, pieces[p].y) + 1]++;
    }
    for (int i = 0; i < ORDER_CELLS; i++) {
        first[i + 1] += first[i];
    }
    const uint32_t count = first[ORDER_CELLS];
    uint32_t *triangles = chunk->piece_triangles + chunk->piece_count;
    float *ends = chunk->piece_ends + chunk->piece_count;
    for (uint32_t p = cell->first_piece; p != ALPI_NONE; p = pieces[p].next) {
        const uint32_t at = first[cell_of_point(pieces[p].x, pieces[p].y)]++;
        triangles[at] = pieces[p].triangle;
        ends[at] = (float)(pieces[p].area / cell->area);
    }
    double total = 0.0, sum = 0.0;
    for (uint32_t k = 0; k < count; k++) {
        total += (double)ends[k];
    }
    for (uint32_t k = 0; k < count; k++) {
        sum += (double)ends[k];
        ends[k] = total > 0.0 ? (float)(sum / total) : 1.0f; // 0: all too small for a float
    }
    ends[count - 1] = 1.0f;
    chunk->piece_count += count;
    return count;
}

/// Whether a texel lies inside one triangle, but for what its float coordinates may be off.
static bool is_whole(const alp_atlas *atlas, const alpi_band *band, const alpi_cell *cell)
{
    const double margin = 2.0 * (0x1p-23 * atlas->info.width + 1e-7);
    return band->pieces[cell->first_piece].next == ALPI_NONE && cell->coverage >= 1.0 - margin;
}

// --- texels --------------------------------------------------------------------------------------

static void write_texel(const alp_atlas *atlas, const alpi_band *band, const alpi_cell *cell,
                        carrier *c, alpi_texel_chunk *chunk)
{
    alpi_texel_record *record = &chunk->records[chunk->texel_count++];
    double b[2];
    if (c->triangle != cell->triangle) {
        load_carrier(atlas, cell->triangle, c);
    }
    find_barycentrics(c, cell->x, cell->y, b);
    record->triangle = cell->triangle;
    record->piece_count = is_whole(atlas, band, cell) ? 0 : write_pieces(band, cell, chunk);
    record->area = (float)cell->area;
    record->coverage = (float)alpi_lesser(cell->coverage, 1.0);
    for (int k = 0; k < 2; k++) {
        record->barycentrics[k] = (float)b[k];
    }
    const float weights[3] = {(float)(1.0 - b[0] - b[1]), (float)b[0], (float)b[1]};
    vec3_store(record->normal, alpi_facet_normal(&c->facet, weights));
}

alp_result alpi_texel_chunk_fill(const alp_atlas *atlas, const alpi_band *band,
                                 alpi_texel_chunk *chunk)
{
    chunk->page = band->page;
    ALPI_TRY_NEW(atlas->context, chunk->records, band->covered);
    ALPI_TRY_NEW(atlas->context, chunk->piece_triangles, band->piece_count);
    ALPI_TRY_NEW(atlas->context, chunk->piece_ends, band->piece_count);
    carrier c = {.triangle = ALPI_NONE};
    for (uint32_t y = band->first_row; y < band->end_row; y++) {
        const uint32_t row = y - band->first_row;
        const alpi_cell *cells = band->cells + (size_t)row * band->width;
        for (uint32_t x = band->columns[row][0]; x < band->columns[row][1]; x++) {
            if (cells[x].first_piece != ALPI_NONE) {
                chunk->records[chunk->texel_count].x = (uint16_t)x;
                chunk->records[chunk->texel_count].y = (uint16_t)y;
                write_texel(atlas, band, &cells[x], &c, chunk);
            }
        }
    }
    return ALP_OK;
}

alp_result alpi_texel_chunks_create(const alp_atlas *atlas, alpi_texel_chunks *chunks)
{
    chunks->count = atlas->info.pages * alpi_raster_bands(atlas);
    ALPI_TRY_NEW(atlas->context, chunks->chunks, chunks->count);
    return ALP_OK;
}

static void release_chunk(alp_context *context, alpi_texel_chunk *chunk)
{
    alpi_release(context, chunk->records);
    alpi_release(context, chunk->piece_triangles);
    alpi_release(context, chunk->piece_ends);
    *chunk = (alpi_texel_chunk){0};
}

void alpi_texel_chunks_destroy(alp_context *context, alpi_texel_chunks *chunks)
{
    for (uint32_t i = 0; chunks->chunks != NULL && i < chunks->count; i++) {
        release_chunk(context, &chunks->chunks[i]);
    }
    alpi_release(context, chunks->chunks);
    *chunks = (alpi_texel_chunks){0};
}
