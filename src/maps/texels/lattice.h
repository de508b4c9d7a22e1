// SPDX-License-Identifier: MIT
// The adaptive lattice: every 4th texel is traced, those between are interpolated where the traced
// ones agree, and traced where they do not.
// Based on: H. Elias. Radiosity (the adaptive light map: spacing 4, passes of two types, half the
// spacing). What such a lattice misses, small details, the flood of its judge finds.
#ifndef ALPI_MAPS_LATTICE_H
#define ALPI_MAPS_LATTICE_H

#include "atlas/atlas.h"

enum { ALPI_LATTICE_SPACING = 4, ALPI_STENCIL_LIMIT = 8 };

typedef enum alpi_texel_state {
    ALPI_TEXEL_OPEN = 0, // nothing is known yet
    ALPI_TEXEL_TRACED,
    ALPI_TEXEL_INTERPOLATED
} alpi_texel_state;

/// Neighbourhood of the texels of an atlas, and what is known of each.
typedef struct alpi_lattice {
    alp_context *context;
    const alpi_texels *texels;
    uint32_t width, height, page_count;
    uint32_t *grid;  // [pages][height][width] texel, ALPI_NONE where there is none
    uint32_t *order; // [count] all texels, tile by tile: neighbours in it are neighbours in space
    uint8_t *states; // [count] alpi_texel_state
    float *values;   // [count] where the state is not OPEN
    bool straight;   // stencils are linear where a cubic would do too: less of the noise, and no
                     // more of the bend than the judge lets pass
    bool along_borders; // a border's texels may be interpolated along it: alpi_lattice_stencil
} alpi_lattice;

/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED by who watches the context
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

/// What an interpolated texel is made of: value = Σ weights · values of `texels`.
typedef struct alpi_stencil {
    uint32_t count;
    uint32_t texels[ALPI_STENCIL_LIMIT];
    float weights[ALPI_STENCIL_LIMIT];
    float spread; // largest minus smallest value of the nearest texels of it
    float bend; // |cubic − linear| of the worse axis; without a cubic a quarter of the difference
} alpi_stencil;

/// The passes, coarsest first. Pass 0 is the lattice; then, for spacing 4 and 2, the texels halfway
/// between two (type 1) and those in the middle of four (type 2). Of spacing 2, type 1 goes in two:
/// those in rows and columns of the lattice first (3), for the sake of borders.
enum { ALPI_LATTICE_PASSES = 6 };
/// The pass a texel belongs to, by its pixel.
uint32_t alpi_lattice_pass(const uint16_t pixel[2]);
/// Texels in their order, pass by pass. @param order [count]   @param by_pass [count] out
/// @param first out: where each pass begins in it, and where the last ends
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_lattice_split(const alpi_lattice *lattice, const uint32_t *order, uint32_t count,
                              uint32_t *by_pass, uint32_t first[ALPI_LATTICE_PASSES + 1]);
/// Whether a texel belongs to the lattice of half the spacing, every second of every second row.
bool alpi_lattice_is_coarse(const uint16_t pixel[2]);
/// Distance in texels to the nearest texels that pass `pass`, from 1 on, interpolates from inside a
/// chart: 2, 2, 1, 1, 1.
uint32_t alpi_lattice_reach(uint32_t pass);

/// How texel t of a pass would be interpolated: cubic where the row or column goes on far enough,
/// else, and in straight lattices, linear. A neighbour is missing if it is in another chart, or
/// turned away. Then, with `along_borders`, a texel in the middle of four takes the two of them
/// that lie along the border, and one of the pass before the last the two of that before it that
/// do.
/// @return false: something is missing
bool alpi_lattice_stencil(const alpi_lattice *lattice, uint32_t texel, alpi_stencil *stencil);
/// Not clamped: a bound on every pass would darken what is nearly open.
float alpi_lattice_interpolate(const alpi_lattice *lattice, const alpi_stencil *stencil);

enum { ALPI_NEIGHBOUR_LIMIT = 8 };
/// The traced texels among the eight around one, of its chart and turned like it. @return how many
uint32_t alpi_lattice_traced_around(const alpi_lattice *lattice, uint32_t texel,
                                    uint32_t around[ALPI_NEIGHBOUR_LIMIT]);

/// How far an interpolated texel with a traced one beside it is from the mean of its four
/// neighbours; half its step to a traced one where a neighbour is missing; 0 with none traced.
float alpi_lattice_kink(const alpi_lattice *lattice, uint32_t texel);

/// Who says which texels may be interpolated.
typedef struct alpi_lattice_judge {
    alpi_lattice *lattice; // gets states and values of what is interpolated
    const uint32_t *order;
    const uint8_t *near;          // [texels] alpi_nearness, or NULL: all are far
    uint8_t *wanted;              // [texels] to be traced, in and out
    float spread, bend, kink;     // the most there may be, times `noise`
    float near_spread, near_bend; // shares of spread and bend, for texels near another surface
    float (*noise)(const void *user, float level); // about a value; NULL: 1
    const void *user;
    uint32_t pass; // whose texels are judged by their stencils
    bool flood;    // instead, interpolated ones of every pass by their kinks
} alpi_lattice_judge;

/// Interpolates texels order[begin] to order[end − 1] that may be, and wants the others traced.
void alpi_lattice_judge_range(const alpi_lattice_judge *judge, uint32_t begin, uint32_t end);

#endif
