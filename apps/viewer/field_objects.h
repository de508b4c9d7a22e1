// SPDX-License-Identifier: MIT
// One look-up an object: irradiance at the middle of its bounds, for every normal.
#ifndef VIEWER_FIELD_OBJECTS_H
#define VIEWER_FIELD_OBJECTS_H

#include <alpenglow/field.h>

enum { FIELD_OBJECT_COEFFICIENTS = 9 };

/// Projects E of a field at the middle of each object onto nine spherical harmonics, as a sum over
/// the twelve corners n_i of an icosahedron:
///     c_lm = 4π / 12 Σ E(n_i) Y_lm(n_i),   E(n) ≈ Σ c_lm Y_lm(n)
/// The corners are a spherical design of degree 5: E of nine coefficients or fewer is exact.
/// An object is a row of surfaces of one name that is not empty, as those of a node are.
/// Based on: R. H. Hardin, N. J. A. Sloane. McLaren's Improved Snub Cube and Other New Spherical
///           Designs in Three Dimensions. Discrete & Computational Geometry 15, 1996.
/// @param coefficients [surfaces][9][4] out; the fourth value is 0
void field_objects_read(const alp_field *field, uint32_t workers, const alp_scene *scene,
                        float (*coefficients)[FIELD_OBJECT_COEFFICIENTS][4]);

#endif
