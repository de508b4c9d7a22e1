// SPDX-License-Identifier: MIT
// Rotation of real spherical harmonics, band by band.
// Based on: J. Ivanic, K. Ruedenberg. Rotation Matrices for Real Spherical Harmonics. Direct
//           Determination by Recursion. J. Phys. Chem. 100(15), 1996, with the corrections of 1998.
#ifndef ALPI_SH_ROTATION_H
#define ALPI_SH_ROTATION_H

#include "sh/basis.h"

enum { ALPI_SH_ROW_LIMIT = 2 * ALPI_SH_ORDER_LIMIT + 1 };

/// Matrices of bands 0 to `order`: element [l][m + l][n + l] takes coefficient n to m.
typedef struct alpi_sh_rotation {
    int order;
    double bands[ALPI_SH_ORDER_LIMIT + 1][ALPI_SH_ROW_LIMIT][ALPI_SH_ROW_LIMIT];
} alpi_sh_rotation;

/// @param order  0 to ALPI_SH_ORDER_LIMIT
/// @param matrix orthonormal, column-major: the images of x, y and z; may mirror
void alpi_sh_rotation_set(alpi_sh_rotation *rotation, int order, const double matrix[9]);

/// turned(R ω) = c(ω). @param c, turned [(order + 1)²], not the same
void alpi_sh_rotation_apply(const alpi_sh_rotation *rotation, const double *c, double *turned);

#endif
