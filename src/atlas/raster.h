// SPDX-License-Identifier: MIT
// What the triangles of an atlas leave in its texels.
#ifndef ALPI_ATLAS_RASTER_H
#define ALPI_ATLAS_RASTER_H

#include "atlas/clip.h"

/// What the triangles leave in one texel.
typedef struct alpi_cell {
    double coverage;      // Σ area inside, in texels; above 1 where triangles overlap
    double area;          // the same in the world, m²
    double piece;         // area of the largest piece, in texels
    double depth;         // of the centre inside the triangle it is deepest in, texels
    double x, y;          // the receiver, in texels
    uint32_t triangle;    // the one it lies on; ALPI_NONE = none: nothing is here
    uint32_t other;       // a triangle that covers what another covers already, else ALPI_NONE
    uint32_t first_piece; // of its list, the last triangle first
    bool center;          // the receiver is the texel's centre
} alpi_cell;

/// A triangle's part of a texel.
typedef struct alpi_piece {
    double area; // m²
    uint32_t triangle;
    uint32_t next; // of the same texel, or ALPI_NONE
    float x, y;    // centroid in the texel, [0, 1]
} alpi_piece;

/// Rows of a page with all that is in them.
typedef struct alpi_band {
    uint32_t page, index;        // index: among the bands of the call, page by page from the top
    uint32_t first_row, end_row; // of the page
    uint32_t width, covered, piece_count;
    const uint32_t (*columns)[2]; // [rows] first column that may hold something, one past the last
    const alpi_cell *cells;       // [rows][width]
    const alpi_piece *pieces;     // [piece_count]
} alpi_band;
/// May be called by several workers at once, with different bands, in any order.
typedef alp_result alpi_band_fn(void *user, const alpi_band *band);

/// How many bands a page has.
uint32_t alpi_raster_bands(const alp_atlas *atlas);

/// Clips every usable triangle of the pages [first_page, end_page) against the texels, on all
/// workers, and hands out the bands that hold something. Memory: some bytes per triangle and a
/// band's cells per worker.
alp_result alpi_raster(const alp_atlas *atlas, uint32_t first_page, uint32_t end_page,
                       alpi_band_fn *finish, void *user);

#endif
