// SPDX-License-Identifier: MIT
// Real spherical harmonics, index l(l+1)+m, without the Condon–Shortley sign.
// Based on: R. Ramamoorthi, P. Hanrahan. An Efficient Representation for Irradiance Environment
//           Maps. SIGGRAPH 2001.
#ifndef ALPI_SH_BASIS_H
#define ALPI_SH_BASIS_H

#include "base/vec.h"

#include <alpenglow/shared_constants.h>

enum {
    ALPI_SH1_COUNT = 4,                                                   // bands 0 and 1
    ALPI_SH_ORDER_LIMIT = 5,                                              // highest band
    ALPI_SH_LIMIT = (ALPI_SH_ORDER_LIMIT + 1) * (ALPI_SH_ORDER_LIMIT + 1) // functions up to it
};

/// √(1/4π), and √(3/4π) times y, z and x.
static inline void alpi_sh1_basis(vec3 unit, double values[ALPI_SH1_COUNT])
{
    values[0] = ALP_SH_Y0;
    values[1] = ALP_SH_Y1 * (double)unit.y;
    values[2] = ALP_SH_Y1 * (double)unit.z;
    values[3] = ALP_SH_Y1 * (double)unit.x;
}

/// All functions up to a band, in double.
/// @param order  highest band, 0 to ALPI_SH_ORDER_LIMIT
/// @param values out: [(order + 1)²]
void alpi_sh_basis(int order, const double unit[3], double *values);

/// A_l of any band: irradiance from radiance, the integral of a clamped cosine times P_l over the
/// sphere. π, 2π/3, π/4, 0, −π/24, 0, …
double alpi_sh_cosine_factor(int band);

#endif
