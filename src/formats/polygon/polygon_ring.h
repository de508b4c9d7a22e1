// SPDX-License-Identifier: MIT
// A polygon in its plane as one ring, between polygon.c, which cuts it, and polygon_holes.c, which
// joins its holes to the outline.
#ifndef ALPI_FORMATS_POLYGON_RING_H
#define ALPI_FORMATS_POLYGON_RING_H

#include "formats/polygon/polygon.h"

typedef struct alpi_plane_point {
    double x, y;
} alpi_plane_point;

/// The outline turns counter-clockwise.
typedef struct alpi_polygon_ring {
    uint32_t count; // corners made so far
    alpi_plane_point *points;
    uint32_t *origins;         // the polygon's corner that each is
    uint32_t *before, *behind; // the corners beside each
} alpi_polygon_ring;

/// Twice the signed area of a triangle. Of floats the differences are exact, or nearly so.
static inline double alpi_plane_turn(alpi_plane_point a, alpi_plane_point b, alpi_plane_point c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static inline bool alpi_plane_same(alpi_plane_point a, alpi_plane_point b)
{
    return a.x == b.x && a.y == b.y;
}

/// Links corners [begin, end) to a ring of their own, the other way round where `turned`.
void alpi_polygon_link(alpi_polygon_ring *ring, uint32_t begin, uint32_t end, bool turned);

/// Joins the rings of the holes to that of the outline by bridges: two corners more for each hole,
/// for which there must be room. On entry all corners of the polygon are there and the outline is
/// linked. *outside: some hole lies outside.
/// @return ALP_OK; LIMIT; OUT_OF_MEMORY
alp_result alpi_polygon_join_holes(alpi_polygon_scratch *scratch, const alpi_polygon_rings *polygon,
                                   alpi_polygon_ring *ring, bool *outside);

#endif
