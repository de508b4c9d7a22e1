// SPDX-License-Identifier: MIT
// Real spherical harmonics of bands 0 and 1, index l(l+1)+m, without the Condon–Shortley sign.
// Based on: R. Ramamoorthi, P. Hanrahan. An Efficient Representation for Irradiance Environment
//           Maps. SIGGRAPH 2001.
#ifndef ALPI_SH_BASIS_H
#define ALPI_SH_BASIS_H

#include "base/vec.h"

enum { ALPI_SH1_COUNT = 4 };

/// √(1/4π), and √(3/4π) times y, z and x.
static inline void alpi_sh1_basis(vec3 unit, double values[ALPI_SH1_COUNT])
{
    values[0] = 0.28209479177387814;
    values[1] = 0.4886025119029199 * (double)unit.y;
    values[2] = 0.4886025119029199 * (double)unit.z;
    values[3] = 0.4886025119029199 * (double)unit.x;
}

#endif
