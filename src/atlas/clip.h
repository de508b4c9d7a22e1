// SPDX-License-Identifier: MIT
// Triangles in their page and the convex polygons that texels cut out of them. Unit: texels.
#ifndef ALPI_ATLAS_CLIP_H
#define ALPI_ATLAS_CLIP_H

#include "atlas/atlas.h"
#include "atlas/facet.h"

/// Of two finite numbers. (fmin and fmax, which care for NaN, are calls: half the time of a texel.)
static inline double alpi_lesser(double a, double b)
{
    return a < b ? a : b;
}

static inline double alpi_greater(double a, double b)
{
    return a > b ? a : b;
}

enum { ALPI_POLYGON_LIMIT = 8 }; // a triangle cut by four lines has at most 7 corners

/// Convex, counter-clockwise.
typedef struct alpi_polygon {
    int count;
    double p[ALPI_POLYGON_LIMIT][2];
} alpi_polygon;

/// The part of `in` with coordinate `axis` ≤ at (keep_low) or ≥ at. `out` is another polygon.
void alpi_polygon_clip(const alpi_polygon *in, int axis, double at, bool keep_low,
                       alpi_polygon *out);
/// The same in place.
void alpi_polygon_cut(alpi_polygon *shape, int axis, double at, bool keep_low);
/// Area and centroid; all 0 where it has no area.
double alpi_polygon_measure(const alpi_polygon *shape, double centroid[2]);

/// A triangle in its page, counter-clockwise.
typedef struct alpi_page_triangle {
    double p[3][2];
    double low[2], high[2]; // its box
    double area;
    uint32_t triangle;
    bool turned; // corners 1 and 2 were exchanged
} alpi_page_triangle;

/// @return false where it has no area in the page; then only `p` is set
bool alpi_page_triangle_load(const alp_atlas *atlas, uint32_t triangle, alpi_page_triangle *out);

/// The texels it may have a share of along an axis (0 columns, 1 rows). Coordinates are 32-bit
/// floats: a side that lies on the border between two texels may be off by their spacing, and must
/// not leak across.
/// @param size of the page along the axis   @return false: none
bool alpi_page_triangle_range(const alpi_page_triangle *triangle, int axis, uint32_t size,
                              uint32_t *first, uint32_t *last);

void alpi_polygon_of_triangle(const alpi_page_triangle *triangle, alpi_polygon *shape);

/// The part of a triangle inside texel (x, y); fewer than three corners: none.
void alpi_page_triangle_cut(const alpi_page_triangle *triangle, uint32_t x, uint32_t y,
                            alpi_polygon *shape);

/// Barycentrics of a triangle's corners 1 and 2 as functions of the page.
typedef struct alpi_page_map {
    double corner[2]; // texels: where both are 0
    double by_x[2], by_y[2];
} alpi_page_map;
alpi_page_map alpi_page_triangle_map(const alpi_page_triangle *triangle);
/// The same from (x, y) in texels on.
static inline alpi_facet_patch alpi_page_map_from(const alpi_page_map *map, double x, double y)
{
    alpi_facet_patch p;
    for (int k = 0; k < 2; k++) {
        p.at[k] = (x - map->corner[0]) * map->by_x[k] + (y - map->corner[1]) * map->by_y[k];
        p.by_x[k] = map->by_x[k];
        p.by_y[k] = map->by_y[k];
    }
    return p;
}
/// Both in one step.
alpi_facet_patch alpi_page_triangle_patch(const alpi_page_triangle *triangle, double x, double y);

#endif
