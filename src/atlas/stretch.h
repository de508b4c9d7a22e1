// SPDX-License-Identifier: MIT
// How a map stretches its surface: what texels lose by shear and by unlike densities.
// Based on: P. V. Sander, J. Snyder, S. J. Gortler, H. Hoppe. Texture Mapping Progressive Meshes.
// SIGGRAPH 2001.
#ifndef ALPI_ATLAS_STRETCH_H
#define ALPI_ATLAS_STRETCH_H

#include "atlas/atlas.h"

/// L2 stretch of a triangle: √((Γ² + γ²) / 2) of the singular values Γ ≥ γ of the affine map from
/// the texture to the surface; in the surface's unit over the map's. Infinite where the triangle
/// has no area in the map. The sign of its area does not matter.
double alpi_stretch_of(const vec3 surface[3], const double map[3][2]);

typedef struct alpi_stretch_facts {
    double base; // texels per metre of what has a factor of 1: √(texel area / Σ factor² · area)
    // Times base times the factor of the triangle: 1 = its share of the texels without shear.
    double mean; // √(Σ L2² · factor² · area / Σ factor² · area) over what are no slivers; ≥ 1
    double worst;  // of them
    double spread; // 99th over 1st percentile, by factor² · area, of density / (base · factor)
    double texels_per_metre; // √(texel area / area of the surface)
    uint32_t worst_triangle; // ALPI_NONE: all are slivers
    uint32_t flipped;        // signed area in the map ≤ 0
    uint32_t first_flipped;  // ALPI_NONE: none
    uint32_t slivers;
} alpi_stretch_facts;
/// Measures the usable triangles that have a page. Slivers are triangles lower than 1/64 of a texel
/// at the density asked of them: 32-bit coordinates do not hold their shape (half a spacing of them
/// is 1/500 of such a height on a page of 1024, 1/32 on one of 16384), no texel shows it, and the
/// layout draws charts as small as they larger than they are. They are in none of the stretches;
/// among the flipped only where they are turned over by more than the coordinates are rounded. A
/// triangle that is small, but no sliver, counts whole: many of them may share a texel and its
/// stretch. A map is as dense as it is drawn: slivers and small charts that were enlarged count in
/// the mean density as what they take.
alp_result alpi_stretch_measure(const alp_atlas *atlas, alpi_stretch_facts *facts);

/// Whether a triangle is one of these.
/// @param base as in the facts; without factors it is the mean density
bool alpi_stretch_is_sliver(const alp_atlas *atlas, uint32_t triangle, double base);

#endif
