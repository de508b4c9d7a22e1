// SPDX-License-Identifier: MIT
// Equirectangular maps: row 0 is up (+Y), the middle column −Z, columns to its right turn to +X.
#ifndef ALPI_SH_EQUIRECT_H
#define ALPI_SH_EQUIRECT_H

#include "base/vec.h"

#include <stdint.h>

/// Integrals over the polar angle θ of row y, for one radian of azimuth. A row of all azimuths has
/// 2π times `one`.
typedef struct alpi_equirect_row {
    double one;      // ∫ sinθ dθ, so that the solid angles of all texels sum to 4π
    double up;       // ∫ cosθ sinθ dθ
    double aside;    // ∫ sin²θ dθ
    double up_up;    // ∫ cos²θ sinθ dθ
    double up_aside; // ∫ cosθ sin²θ dθ
} alpi_equirect_row;
alpi_equirect_row alpi_equirect_row_integrals(uint32_t row, uint32_t height);

/// Unit vector to the centre of a texel.
vec3 alpi_equirect_direction(uint32_t width, uint32_t height, uint32_t column, uint32_t row);

#endif
