// SPDX-License-Identifier: MIT
// The adaptive lattice: every 4th texel of every 4th row is traced. Texels between are interpolated
// if the traced ones agree, and traced otherwise. The flood finds small details that the lattice
// misses: it traces around texels that differ from a traced neighbour.
// Based on: H. Elias. Radiosity (the adaptive light map: spacing 4, levels of two types, half the
// spacing).
#ifndef ALPI_MAPS_LATTICE_H
#define ALPI_MAPS_LATTICE_H

#include "atlas/atlas.h"
#include "base/tasks.h"

enum { ALPI_LATTICE_SPACING = 4, ALPI_STENCIL_LIMIT = 8 };

typedef enum alpi_texel_state {
    ALPI_TEXEL_OPEN = 0, // neither traced nor interpolated yet
    ALPI_TEXEL_TRACED,
    ALPI_TEXEL_INTERPOLATED
} alpi_texel_state;

/// The texels of an atlas as a grid, with the state and value of each.
typedef struct alpi_lattice {
    alp_context *context;
    const alpi_texels *texels;
    uint32_t width, height, page_count;
    uint32_t *grid;  // [pages][height][width] texel, ALPI_NONE where there is none
    uint32_t *order; // [count] all texels, tile by tile, so that successive ones are close
    uint8_t *states; // [count] alpi_texel_state
    float *values;   // [count] where the state is not OPEN
    // All stencils are linear: less noise than a cubic, and the judge limits the error. At a border
    // of a chart they run along it: alpi_lattice_stencil.
    bool straight;
} alpi_lattice;

/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED by the watch of the context
alp_result alpi_lattice_create(const alp_atlas *atlas, const alpi_texels *texels,
                               alpi_lattice *lattice);
void alpi_lattice_destroy(alpi_lattice *lattice);

/// Place of a pixel in arrays over all pages.
static inline size_t alpi_lattice_pixel(const alpi_lattice *lattice, uint32_t page, uint32_t x,
                                        uint32_t y)
{
    return ((size_t)page * lattice->height + y) * lattice->width + x;
}

/// The texel at a pixel, ALPI_NONE where there is none or the pixel is off the page.
uint32_t alpi_lattice_texel(const alpi_lattice *lattice, uint32_t page, int64_t x, int64_t y);

enum { ALPI_AROUND_LIMIT = 9 };
/// The texels of the 3 × 3 pixels around a texel, itself among them, of all charts, row by row.
/// @return how many
uint32_t alpi_lattice_around(const alpi_lattice *lattice, uint32_t texel,
                             uint32_t around[ALPI_AROUND_LIMIT]);

/// A stencil interpolates a texel: value = Σ weights · values of `texels`.
typedef struct alpi_stencil {
    uint32_t count;
    uint32_t texels[ALPI_STENCIL_LIMIT];
    float weights[ALPI_STENCIL_LIMIT];
    float spread; // largest minus smallest value of the nearest texels of it
    float bend; // |cubic − linear| of the worse axis; without a cubic a quarter of the difference
} alpi_stencil;

/// The levels, coarsest first. Level 0 is the lattice. For spacing 4 and 2 follow the texels
/// halfway between two (type 1) and those in the middle of four (type 2). Type 1 of spacing 2 takes
/// two levels, rows and columns of the lattice first (3), so that borders can use them.
enum { ALPI_LATTICE_LEVELS = 6 };
/// The level a texel belongs to, by its pixel.
uint32_t alpi_lattice_level(const uint16_t pixel[2]);
/// Whether a texel belongs to the lattice of half the spacing, every second of every second row.
bool alpi_lattice_is_coarse(const uint16_t pixel[2]);
/// Distance in texels to the nearest texels of the stencils of a level, from 1 on, inside a chart:
/// 2, 2, 1, 1, 1.
uint32_t alpi_lattice_reach(uint32_t level);

/// The stencil of a texel: cubic if the row or column is long enough and the lattice not straight,
/// else linear. A neighbour is missing if it is in another chart or turned away. If the lattice is
/// straight, a texel in the middle of four then takes two along the border, and a texel of the
/// level before the last takes two of the level before it.
/// @return false: texels are missing
bool alpi_lattice_stencil(const alpi_lattice *lattice, uint32_t texel, alpi_stencil *stencil);
/// The interpolated value, not clamped: clamping each level would darken nearly open texels.
float alpi_lattice_interpolate(const alpi_lattice *lattice, const alpi_stencil *stencil);

/// Computes a quantity of an interpolated texel by its stencil.
typedef void alpi_stencil_fn(void *user, uint32_t texel, const alpi_stencil *stencil);
/// Calls `body` for each interpolated texel of an order, level by level, as a stencil holds texels
/// of coarser levels. @param progress NULL, or a callback that may cancel
/// @return ALP_OK; CANCELLED
alp_result alpi_lattice_for_stencils(const alpi_lattice *lattice, const uint32_t *order,
                                     uint32_t count, alpi_stencil_fn *body, void *user,
                                     const alpi_task_progress *progress);

enum { ALPI_NEIGHBOUR_LIMIT = 8 };
/// The traced texels among the eight around one, of its chart and turned like it. @return how many
uint32_t alpi_lattice_traced_around(const alpi_lattice *lattice, uint32_t texel,
                                    uint32_t around[ALPI_NEIGHBOUR_LIMIT]);

/// How far an interpolated texel with a traced one beside it is from the mean of its four
/// neighbours; half its step to a traced one where a neighbour is missing; 0 with none traced.
float alpi_lattice_kink(const alpi_lattice *lattice, uint32_t texel);

/// The judge decides which texels may be interpolated.
typedef struct alpi_lattice_judge {
    alpi_lattice *lattice; // states and values of interpolated texels are written
    const uint32_t *order;
    const uint8_t *proximity;     // [texels] alpi_proximity, or NULL: all are far
    uint8_t *marked;              // [texels] to be traced, in and out
    float spread, bend, kink;     // the most there may be, times `noise`
    float near_spread, near_bend; // shares of spread and bend, for texels near another surface
    float (*noise)(const void *user, float value); // about a value; NULL: 1
    const void *user;
    uint32_t level; // whose texels are judged by their stencils
    bool flood;     // instead, interpolated ones of every level by their kinks
} alpi_lattice_judge;

/// Interpolates those of the texels order[begin] to order[end − 1] that may be, and marks the
/// others.
void alpi_lattice_judge_range(const alpi_lattice_judge *judge, uint32_t begin, uint32_t end);

#endif
