// SPDX-License-Identifier: MIT
// The tightest box round points of the plane.
#ifndef ALPI_ATLAS_BOX_H
#define ALPI_ATLAS_BOX_H

#include <stddef.h>

typedef struct alpi_point {
    double x, y;
} alpi_point;

/// A box with sides along `axis` (unit) and across it (turned counter-clockwise).
typedef struct alpi_box {
    alpi_point axis;
    double low_x, low_y;  // of the points along and across the axis
    double width, height; // ≥ 0
} alpi_box;

/// The box of least area round `count` ≥ 1 points, which are reordered: convex hull by monotone
/// chain, then rotating calipers, since one side of that box lies along a side of the hull.
/// Of equal boxes the first side's, seen from the lowest x. O(n log n).
/// Based on: A. M. Andrew. Another Efficient Algorithm for Convex Hulls in Two Dimensions. IPL
/// 9(5), 1979; H. Freeman, R. Shapira. Determining the Minimum-Area Encasing Rectangle for an
/// Arbitrary Closed Curve. CACM 18(7), 1975; G. T. Toussaint. Solving Geometric Problems with the
/// Rotating Calipers. MELECON, 1983.
/// @param hull room for 2·count points
alpi_box alpi_tightest_box(alpi_point *points, size_t count, alpi_point *hull);

/// The lowest box of a triangle: along its longest edge.
alpi_box alpi_lowest_box(const alpi_point triangle[3]);
/// The box of a triangle whose longer side is least, so that of the smallest square round it.
alpi_box alpi_smallest_square(const alpi_point triangle[3]);

#endif
