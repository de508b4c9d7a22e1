// SPDX-License-Identifier: MIT
// Cube maps: directions and solid angles of texels. Faces and their axes are those of
// alp_cube_face.
#ifndef ALPI_SH_CUBE_MAP_H
#define ALPI_SH_CUBE_MAP_H

#include "base/vec.h"

#include <alpenglow/sh.h>

enum { ALPI_CUBE_FACES = 6 };

/// An axis of the world, 0 to 2, and a sign.
typedef struct alpi_signed_axis {
    int index;
    double sign;
} alpi_signed_axis;

/// Axes of a face: columns run along s, rows along t, and n is the middle.
typedef struct alpi_cube_axes {
    alpi_signed_axis s, t, n;
} alpi_cube_axes;
const alpi_cube_axes *alpi_cube_face_axes(alp_cube_face face);

/// Unit vector to a point of a face. @param s, t [−1, 1], to the right and downwards
vec3 alpi_cube_direction(alp_cube_face face, double s, double t);
/// Unit vector to the centre of a texel.
vec3 alpi_cube_texel_direction(alp_cube_face face, uint32_t size, uint32_t column, uint32_t row);

/// Solid angle of a texel, exactly: those of a cube map sum to 4π.
///
///     dω = A₁₁ − A₀₁ − A₁₀ + A₀₀,   A(s, t) = atan2(s t, √(s² + t² + 1)) at the corners
double alpi_cube_texel_solid_angle(uint32_t size, uint32_t column, uint32_t row);

#endif
