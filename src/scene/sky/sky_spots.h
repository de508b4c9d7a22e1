// SPDX-License-Identifier: MIT
// A sky of an image as two: a soft one, which few rays find evenly lit, and the bright spots that
// stick out of it, of which it is known beforehand where to look.
#ifndef ALPI_SCENE_SKY_SPOTS_H
#define ALPI_SCENE_SKY_SPOTS_H

#include "scene/sky/sky_table.h"

enum {
    ALPI_SKY_LOOKS = 1 << 14, // a lamp that gives a thousandth of the light has 16 of them
    ALPI_LOOK_BLOCK = 16,     // that follow each other, and are near each other
    ALPI_LOOK_BLOCKS = ALPI_SKY_LOOKS / ALPI_LOOK_BLOCK
};

/// Looks at spots, as arrays to be walked along; and what a normal n makes of a block of them
/// without a walk, where all of it is above the horizon: Σ n·ω = n · Σ ω, Σ l n·ω = n · Σ l ω.
typedef struct alpi_sky_looks {
    float direction[3][ALPI_SKY_LOOKS];   // ω, unit
    float light[3][ALPI_SKY_LOOKS];       // l = ∫ L dω of what a look stands for, W·m⁻²
    float axis[3][ALPI_LOOK_BLOCKS];      // of a block; unit, or 0
    float apart[ALPI_LOOK_BLOCKS];        // |ω − axis| ≤ this, of all of the block
    float sum[3][ALPI_LOOK_BLOCKS];       // Σ ω
    float moment[3][3][ALPI_LOOK_BLOCKS]; // Σ l ω, by channel
} alpi_sky_looks;

/// Parts a table by brightness: no more of a pixel than `level` is soft, what is above it, in the
/// pixel's colour, a spot. The two radiances add up to the table's in every direction.
/// The level is the highest that leaves the soft part even: its mean square is `unevenness` times
/// its squared mean, or what is black makes it so. 1 would be the same from everywhere, 2 an even
/// sky over a black ground. Of a sky that is mostly black nothing is soft.
/// @param soft, spots made here and finished; without spots (`total` 0) the table was soft already
/// @return ALP_OK; OUT_OF_MEMORY. On failure too the caller releases both
alp_result alpi_sky_spots_part(alp_context *context, const alpi_sky_table *table, double unevenness,
                               alpi_sky_table *soft, alpi_sky_table *spots);

/// Draws looks from a table that is not black, in proportion to its brightness, stratified: Σ light
/// f(direction) is ∫ L f dω. They are in an order in which those that follow each other are
/// neighbours: to take one in n of them, from a random first on, is to draw stratified directions.
/// @param looks out: the caller's to release
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_sky_spots_look(alp_context *context, const alpi_sky_table *table,
                               alpi_sky_looks **looks);

#endif
