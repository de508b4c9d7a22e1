// SPDX-License-Identifier: MIT
// Projection of cube maps: the table of integrals, rows in any order, and coefficients from
// moments.
#include "sh/sh_project.h"

#include "base/memory.h"

#include <string.h>

// --- the table -----------------------------------------------------------------------------------

enum { NODES = 4, FINE = 32 };

/// Gauss–Legendre quadrature in [0, 1].
static const double nodes[NODES] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                    0.93056815579702629};
static const double node_weights[NODES] = {0.17392742256872693, 0.32607257743127307,
                                           0.32607257743127307, 0.17392742256872693};

/// Adds the moments of one point (s, t), weighted with its solid angle.
static void add_point(double s, double t, double area, double moments[ALPI_CUBE_MOMENTS])
{
    const double inverse = 1.0 / sqrt(s * s + t * t + 1.0);
    const double weight = area * inverse * inverse * inverse;
    const double a = s * inverse, b = t * inverse, c = inverse;
    const double values[ALPI_CUBE_MOMENTS] = {1.0,   c, c * c, a * a - b * b, a,
                                              a * c, b, b * c, a * b};
    for (int i = 0; i < ALPI_CUBE_MOMENTS; i++) {
        moments[i] += weight * values[i];
    }
}

/// Moments of a texel, by quadrature of parts at most 1/16 wide, which is exact to rounding.
static void integrate_texel(uint32_t size, uint32_t column, uint32_t row,
                            double moments[ALPI_CUBE_MOMENTS])
{
    const uint32_t parts = (FINE + size - 1) / size;
    const double step = 2.0 / size / parts;
    const double s0 = 2.0 * column / size - 1.0, t0 = 2.0 * row / size - 1.0;
    memset(moments, 0, ALPI_CUBE_MOMENTS * sizeof *moments);
    for (uint32_t y = 0; y < parts * NODES; y++) {
        const uint32_t part = y / NODES;
        const double t = t0 + step * (part + nodes[y % NODES]);
        for (uint32_t x = 0; x < parts * NODES; x++) {
            const uint32_t column_part = x / NODES;
            const double s = s0 + step * (column_part + nodes[x % NODES]);
            const double area = step * step * node_weights[x % NODES] * node_weights[y % NODES];
            add_point(s, t, area, moments);
        }
    }
    moments[0] = alpi_cube_texel_solid_angle(size, column, row);
}

/// Fills the weights of a quarter of a face: columns and rows on the positive sides of s and t,
/// from the outermost inwards.
static void fill_table(alpi_cube_table *t)
{
    for (uint32_t pair = 0; pair < t->half; pair++) {
        for (uint32_t i = 0; i < t->half; i++) {
            double moments[ALPI_CUBE_MOMENTS];
            const uint32_t column = t->size - 1 - i, row = t->size - 1 - pair;
            integrate_texel(t->size, column, row, moments);
            // A middle column is read from both ends of its row.
            const double share = column == i ? 0.5 : 1.0;
            alpi_eight *block =
                t->weights + ((size_t)pair * t->blocks + i / ALPI_CUBE_LANES) * ALPI_CUBE_MOMENTS;
            for (int m = 0; m < ALPI_CUBE_MOMENTS; m++) {
                const bool odd_t = m >= 6;
                block[m].at[i % ALPI_CUBE_LANES] =
                    odd_t && row == pair ? 0.0f : (float)(share * moments[m]);
            }
        }
    }
}

alp_result alpi_cube_table_create(alp_context *context, uint32_t size, alpi_cube_table *table)
{
    *table = (alpi_cube_table){.size = size, .half = (size + 1) / 2};
    table->blocks = (table->half + ALPI_CUBE_LANES - 1) / ALPI_CUBE_LANES;
    const size_t count = (size_t)table->half * table->blocks * ALPI_CUBE_MOMENTS;
    table->memory = alpi_allocate(context, count + 1, sizeof *table->weights);
    if (table->memory == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const size_t over = (uintptr_t)table->memory % sizeof *table->weights;
    table->weights =
        (void *)((char *)table->memory + (over > 0 ? sizeof *table->weights - over : 0));
    ALPI_TRY_NEW(context, table->darkness, 3 * (size_t)size);
    fill_table(table);
    return ALP_OK;
}

void alpi_cube_table_release(alp_context *context, alpi_cube_table *table)
{
    alpi_release(context, table->memory);
    alpi_release(context, table->darkness);
    *table = (alpi_cube_table){0};
}

// --- rows ----------------------------------------------------------------------------------------

enum { SINGLE_LIMIT = 64 }; // products that are added in single precision

/// Mirrored pairs [first, end) of which one row is present.
typedef struct pair_range {
    uint32_t first, end;
} pair_range;

static uint32_t at_most(uint32_t value, uint32_t limit)
{
    return value < limit ? value : limit;
}

static bool holds(pair_range range, uint32_t pair)
{
    return pair >= range.first && pair < range.end;
}

/// The next pair from which on `range` is present, or no longer; else `end`.
static uint32_t next_change(pair_range range, uint32_t pair, uint32_t end)
{
    const uint32_t change = pair < range.first ? range.first : range.end;
    return change > pair && change < end ? change : end;
}

/// Adds pairs [first, end), whose upper rows are all present or not, and so are the lower ones.
/// @param top, bottom rows of the first pair; NULL where they are not present
static void add_pairs(const alpi_cube_table *t, alpi_cube_sum_fn *sum, pair_range pairs,
                      const float *top, const float *bottom, double sums[3][ALPI_CUBE_MOMENTS])
{
    const ptrdiff_t width = 3 * (ptrdiff_t)t->size;
    const alpi_cube_rows rows = {.top = top != NULL ? top : t->darkness,
                                 .bottom = bottom != NULL ? bottom : t->darkness,
                                 .top_step = top != NULL ? width : 0,
                                 .bottom_step = bottom != NULL ? -width : 0,
                                 .weights = t->weights +
                                            (size_t)pairs.first * t->blocks * ALPI_CUBE_MOMENTS,
                                 .size = t->size,
                                 .half = t->half,
                                 .blocks = t->blocks,
                                 .pairs = pairs.end - pairs.first};
    float moments[3][ALPI_CUBE_MOMENTS];
    sum(&rows, moments);
    for (int k = 0; k < 3; k++) {
        for (int m = 0; m < ALPI_CUBE_MOMENTS; m++) {
            sums[k][m] += (double)moments[k][m];
        }
    }
}

void alpi_cube_add(const alpi_cube_table *table, alpi_cube_sum_fn *sum, alp_cube_face face,
                   uint32_t first_row, uint32_t row_count, const float *pixels,
                   alpi_cube_sums *sums)
{
    const uint32_t size = table->size, end = first_row + row_count;
    const uint32_t limit = table->blocks < SINGLE_LIMIT ? SINGLE_LIMIT / table->blocks : 1;
    const pair_range tops = {first_row, at_most(end, table->half)};
    const pair_range bottoms = {size - end, at_most(size - first_row, size / 2)};
    uint32_t next = 0;
    for (uint32_t pair = 0; pair < table->half; pair = next) {
        next = at_most(pair + limit, table->half);
        next = next_change(bottoms, pair, next_change(tops, pair, next));
        const bool top = holds(tops, pair), bottom = holds(bottoms, pair);
        const size_t width = 3 * (size_t)size;
        if (top || bottom) {
            add_pairs(table, sum, (pair_range){pair, next},
                      top ? pixels + width * (pair - first_row) : NULL,
                      bottom ? pixels + width * (size - 1 - pair - first_row) : NULL,
                      sums->face[face]);
        }
    }
}

// --- coefficients --------------------------------------------------------------------------------

/// Moments of a channel about the axes of the world. Products of two different axes come as those
/// of y and z, z and x, x and y: each lies at the index of the third axis.
typedef struct world_moments {
    double one, first[3], square[3], product[3];
} world_moments;

static void add_face(const alpi_cube_axes *axes, const double m[ALPI_CUBE_MOMENTS],
                     world_moments *w)
{
    const alpi_signed_axis s = axes->s, t = axes->t, n = axes->n;
    const double rest = m[0] - m[2];
    w->one += m[0];
    w->first[n.index] += n.sign * m[1];
    w->square[n.index] += m[2];
    w->square[s.index] += 0.5 * (rest + m[3]);
    w->square[t.index] += 0.5 * (rest - m[3]);
    w->first[s.index] += s.sign * m[4];
    w->product[t.index] += s.sign * n.sign * m[5];
    w->first[t.index] += t.sign * m[6];
    w->product[s.index] += t.sign * n.sign * m[7];
    w->product[n.index] += s.sign * t.sign * m[8];
}

alpi_sh9 alpi_cube_finish(const alpi_cube_sums *sums)
{
    alpi_sh9 radiance;
    for (int k = 0; k < 3; k++) {
        world_moments w = {.one = 0.0};
        for (int face = 0; face < ALPI_CUBE_FACES; face++) {
            add_face(alpi_cube_face_axes((alp_cube_face)face), sums->face[face][k], &w);
        }
        const double c[ALPI_SH9_COUNT] = {ALP_SH_Y0 * w.one,
                                          ALP_SH_Y1 * w.first[1],
                                          ALP_SH_Y1 * w.first[2],
                                          ALP_SH_Y1 * w.first[0],
                                          ALP_SH_Y2 * w.product[2],
                                          ALP_SH_Y2 * w.product[0],
                                          ALP_SH_Y20 * (3.0 * w.square[2] - w.one),
                                          ALP_SH_Y2 * w.product[1],
                                          ALP_SH_Y22 * (w.square[0] - w.square[1])};
        for (int i = 0; i < ALPI_SH9_COUNT; i++) {
            radiance.c[i][k] = (float)c[i];
        }
    }
    return radiance;
}
