// SPDX-License-Identifier: MIT
// Projection of cube maps to nine coefficients.
//
// A table holds, for each texel, the integrals of the moments 1, ω and ω ωᵗ over it. A face has two
// mirror planes and all faces are alike, so a quarter of one face is enough: the four texels that
// mirror each other are added with their signs first ("folded"), and then multiplied.
//
//     even in s and t   1, c, c², a² − b²       (a, b, c) = ω along s, t and n of the face
//     odd in s          a, ac
//     odd in t          b, bc
//     odd in both       ab
//
// 9 products for 4 texels are left, and no direction, root or solid angle.
// Based on: C. Nilsson, A. Jansson. Ljussättning i realtid med dynamisk ambiansvolym. Chalmers
// 2006,
//           section 8.3: stored products of basis and solid angle, and rows spread over frames.
#ifndef ALPI_SH_SH_PROJECT_H
#define ALPI_SH_SH_PROJECT_H

#include "base/context.h"
#include "sh/cube_map.h"
#include "sh/sh9.h"

enum {
    ALPI_CUBE_LANES = 8,   // columns of a block
    ALPI_CUBE_MOMENTS = 9, // in the order above
    ALPI_CUBE_SIZE_LIMIT = 4096
};

/// A number for each of eight columns.
typedef struct alpi_eight {
    _Alignas(32) float at[ALPI_CUBE_LANES];
} alpi_eight;

/// Integrals of one size of cube map. Read only once made, so any number of threads may share it.
typedef struct alpi_cube_table {
    uint32_t size;
    uint32_t half;       // ⌈size / 2⌉: pairs of mirrored rows, and of mirrored columns
    uint32_t blocks;     // of eight columns in a half row; columns beyond the half weigh 0
    alpi_eight *weights; // [half][blocks][ALPI_CUBE_MOMENTS]; row 0 is the outermost
    float *darkness;     // [size][3] zeros, in the place of a row that is not there
    void *memory;        // of the weights
} alpi_cube_table;

/// @return ALP_OK; OUT_OF_MEMORY. Release it in both cases.
alp_result alpi_cube_table_create(alp_context *context, uint32_t size, alpi_cube_table *table);
void alpi_cube_table_release(alp_context *context, alpi_cube_table *table);

/// Sums of a cube map: moments of each face in its own axes.
typedef struct alpi_cube_sums {
    double face[ALPI_CUBE_FACES][3][ALPI_CUBE_MOMENTS];
} alpi_cube_sums;

/// Mirrored pairs of rows for the inner loop.
typedef struct alpi_cube_rows {
    const float *top, *bottom;       // of the outermost pair, each [size][3]
    ptrdiff_t top_step, bottom_step; // floats to the next pair; 0 stays in darkness
    const alpi_eight *weights;
    uint32_t size, half, blocks, pairs;
} alpi_cube_rows;

/// Moments of some rows. Few pairs at a time, for sums are in single precision.
typedef void alpi_cube_sum_fn(const alpi_cube_rows *rows, float moments[3][ALPI_CUBE_MOMENTS]);
alpi_cube_sum_fn alpi_cube_sum_baseline, alpi_cube_sum_v3;

/// Adds rows of a face. Rows are [row_count][size][3] radiance. Mirrored rows that come in one call
/// share their work.
/// @param sum ALPI_COMPILED_FOR(context, alpi_cube_sum)
void alpi_cube_add(const alpi_cube_table *table, alpi_cube_sum_fn *sum, alp_cube_face face,
                   uint32_t first_row, uint32_t row_count, const float *pixels,
                   alpi_cube_sums *sums);

/// Coefficients from the sums of all six faces.
alpi_sh9 alpi_cube_finish(const alpi_cube_sums *sums);

#endif
