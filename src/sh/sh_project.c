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
        const double t = t0 + step * (y / NODES + nodes[y % NODES]);
        for (uint32_t x = 0; x < parts * NODES; x++) {
            const double s = s0 + step * (x / NODES + nodes[x % NODES]);
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

enum { TOP = 1, BOTTOM = 2, SINGLE_LIMIT = 64 }; // products that are added in single precision

/// Which rows of a mirrored pair lie in [first, end).
static unsigned present(const alpi_cube_table *t, uint32_t pair, uint32_t first, uint32_t end)
{
    const uint32_t mirrored = t->size - 1 - pair;
    const unsigned top = pair >= first && pair < end ? TOP : 0;
    return mirrored != pair && mirrored >= first && mirrored < end ? top | BOTTOM : top;
}

void alpi_cube_add(const alpi_cube_table *table, alpi_cube_sum_fn *sum, alp_cube_face face,
                   uint32_t first_row, uint32_t row_count, const float *pixels,
                   alpi_cube_sums *sums)
{
    const uint32_t end = first_row + row_count;
    const uint32_t limit = table->blocks < SINGLE_LIMIT ? SINGLE_LIMIT / table->blocks : 1;
    const ptrdiff_t width = 3 * (ptrdiff_t)table->size;
    uint32_t next = 0;
    for (uint32_t pair = 0; pair < table->half; pair = next) {
        const unsigned which = present(table, pair, first_row, end);
        next = pair + 1;
        while (next < table->half && next - pair < limit &&
               present(table, next, first_row, end) == which) {
            next++;
        }
        if (which == 0) {
            continue;
        }
        const uint32_t mirrored = table->size - 1 - pair;
        alpi_cube_rows rows = {.top = table->darkness, .bottom = table->darkness};
        if ((which & TOP) != 0) {
            rows.top = pixels + width * (ptrdiff_t)(pair - first_row);
            rows.top_step = width;
        }
        if ((which & BOTTOM) != 0) {
            rows.bottom = pixels + width * (ptrdiff_t)(mirrored - first_row);
            rows.bottom_step = -width;
        }
        rows.weights = table->weights + (size_t)pair * table->blocks * ALPI_CUBE_MOMENTS;
        rows.size = table->size;
        rows.half = table->half;
        rows.blocks = table->blocks;
        rows.pairs = next - pair;
        float moments[3][ALPI_CUBE_MOMENTS];
        sum(&rows, moments);
        for (int k = 0; k < 3; k++) {
            for (int m = 0; m < ALPI_CUBE_MOMENTS; m++) {
                sums->face[face][k][m] += (double)moments[k][m];
            }
        }
    }
}

// --- coefficients --------------------------------------------------------------------------------

/// Moments of a channel about the axes of the world.
typedef struct world_moments {
    double one, first[3], second[3][3];
} world_moments;

/// Adds a face. Its axes are permuted axes of the world with signs.
static void add_face(const alpi_cube_axes *axes, const double m[ALPI_CUBE_MOMENTS],
                     world_moments *w)
{
    const double cc = m[2], aa = 0.5 * (m[0] - cc + m[3]), bb = 0.5 * (m[0] - cc - m[3]);
    const double *s = axes->s, *t = axes->t, *n = axes->n;
    w->one += m[0];
    for (int i = 0; i < 3; i++) {
        w->first[i] += m[4] * s[i] + m[6] * t[i] + m[1] * n[i];
        for (int j = 0; j < 3; j++) {
            w->second[i][j] += aa * s[i] * s[j] + bb * t[i] * t[j] + cc * n[i] * n[j] +
                               m[8] * (s[i] * t[j] + t[i] * s[j]) +
                               m[5] * (s[i] * n[j] + n[i] * s[j]) +
                               m[7] * (t[i] * n[j] + n[i] * t[j]);
        }
    }
}

alpi_sh9 alpi_cube_finish(const alpi_cube_sums *sums)
{
    alpi_sh9 radiance;
    for (int k = 0; k < 3; k++) {
        world_moments w = {0};
        for (int face = 0; face < ALPI_CUBE_FACES; face++) {
            add_face(alpi_cube_face_axes((alp_cube_face)face), sums->face[face][k], &w);
        }
        const double c[ALPI_SH9_COUNT] = {ALP_SH_Y0 * w.one,
                                          ALP_SH_Y1 * w.first[1],
                                          ALP_SH_Y1 * w.first[2],
                                          ALP_SH_Y1 * w.first[0],
                                          ALP_SH_Y2 * w.second[0][1],
                                          ALP_SH_Y2 * w.second[1][2],
                                          ALP_SH_Y20 * (3.0 * w.second[2][2] - w.one),
                                          ALP_SH_Y2 * w.second[0][2],
                                          ALP_SH_Y22 * (w.second[0][0] - w.second[1][1])};
        for (int i = 0; i < ALPI_SH9_COUNT; i++) {
            radiance.c[i][k] = (float)c[i];
        }
    }
    return radiance;
}
