// SPDX-License-Identifier: MIT
// Cube maps: directions and solid angles of texels.
#include "sh/cube_map.h"

const alpi_cube_axes *alpi_cube_face_axes(alp_cube_face face)
{
    enum { X, Y, Z };
    static const alpi_cube_axes axes[ALPI_CUBE_FACES] = {
        {{Z, -1}, {Y, -1}, {X, 1}}, {{Z, 1}, {Y, -1}, {X, -1}}, {{X, 1}, {Z, 1}, {Y, 1}},
        {{X, 1}, {Z, -1}, {Y, -1}}, {{X, 1}, {Y, -1}, {Z, 1}},  {{X, -1}, {Y, -1}, {Z, -1}},
    };
    return &axes[face];
}

vec3 alpi_cube_direction(alp_cube_face face, double s, double t)
{
    const alpi_cube_axes *a = alpi_cube_face_axes(face);
    const double inverse = 1.0 / sqrt(s * s + t * t + 1.0);
    float d[3];
    d[a->s.index] = (float)(s * a->s.sign * inverse);
    d[a->t.index] = (float)(t * a->t.sign * inverse);
    d[a->n.index] = (float)(a->n.sign * inverse);
    return vec3_load(d);
}

vec3 alpi_cube_texel_direction(alp_cube_face face, uint32_t size, uint32_t column, uint32_t row)
{
    return alpi_cube_direction(face, 2.0 * (column + 0.5) / size - 1.0,
                               2.0 * (row + 0.5) / size - 1.0);
}

/// Solid angle of the rectangle from the middle of a face to (s, t), with the sign of s t.
static double corner_angle(double s, double t)
{
    return atan2(s * t, sqrt(s * s + t * t + 1.0));
}

double alpi_cube_texel_solid_angle(uint32_t size, uint32_t column, uint32_t row)
{
    const double s0 = 2.0 * column / size - 1.0, s1 = 2.0 * (column + 1.0) / size - 1.0;
    const double t0 = 2.0 * row / size - 1.0, t1 = 2.0 * (row + 1.0) / size - 1.0;
    return corner_angle(s1, t1) - corner_angle(s0, t1) - corner_angle(s1, t0) +
           corner_angle(s0, t0);
}
