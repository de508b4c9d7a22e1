// SPDX-License-Identifier: MIT
// How a gatherer asks what leaves the surfaces that its rays meet. Whoever stores light on surfaces
// answers; whoever gathers does not know how it is stored.
#ifndef ALPI_TRANSPORT_SURFACE_LIGHT_H
#define ALPI_TRANSPORT_SURFACE_LIGHT_H

#include "trace/trace.h"

/// A point of a surface, as it is looked at.
typedef struct alpi_surface_point {
    uint32_t triangle;
    float b1, b2;     // barycentric weights of corners 1 and 2
    vec3 toward;      // unit: from the surface to who looks
    bool from_behind; // who looks sees the back of the triangle
} alpi_surface_point;

/// Writes the radiance L [W·sr⁻¹·m⁻²] that each point reflects towards who looks: ρE/π of that side
/// of a diffuse surface, and of a pane what it keeps (alpi_pane) of that. What a surface emits is
/// not in it: gatherers ask the scene (alpi_surface_emission), or leave that to direct light.
/// The back of a single-sided surface is black and never asked about. Called by many threads.
/// @param points   [count], count at most ALPI_PACKET   @param radiance [count] out
typedef void alpi_reflected_fn(const void *user, const alpi_surface_point *points, uint32_t count,
                               vec3 *radiance);

/// Cells of surface light that are none: what a ray meets that leaves the scene, and what is black.
enum { ALPI_CELL_ESCAPED = 0, ALPI_CELL_BLACK = 1, ALPI_CELL_FIRST = 2 };
/// Where a cell tells how near is near: the length of its sides on the surface, metres, or more
/// where light changes much within it.
enum { ALPI_CELL_SIDE = 3 };
/// The cells of points that rays of some packets met, CELL_FIRST or more, or CELL_BLACK. Points of
/// many rays at once, since waiting for memory is what takes the time: what one step reads for all
/// of them the step before has asked for. Called by many threads.
/// @param hits  [count], count at most ALPI_LIGHT_BATCH
/// @param met   [count] bit i: lane i met a surface on a side that is not black of itself
/// @param cells [count] out, of those lanes; others are left alone
typedef void alpi_light_cells_fn(const void *user, const alpi_hits *hits, const uint32_t *met,
                                 uint32_t count, uint32_t (*cells)[ALPI_PACKET]);
enum { ALPI_LIGHT_BATCH = 32 };

typedef struct alpi_surface_light {
    alpi_reflected_fn *reflected; // NULL: surfaces reflect nothing
    const void *user;             // what it reads
    // Of light that is the same all over each of some cells, or NULL: then a ray that was traced
    // once need not be again when the light changes.
    alpi_light_cells_fn *find;
    const float (*cells)[4]; // radiance in RGB, and CELL_SIDE; 0 in the first CELL_FIRST
} alpi_surface_light;

#endif
