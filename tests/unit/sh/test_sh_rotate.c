// SPDX-License-Identifier: MIT
// Rotation: rotated coefficients describe the rotated function, in every band.
#include "sh_directions.h"
#include "test_support.h"

#include "sh/rotation.h"

/// A rotation about an axis, column-major.
static void turn(vec3 axis, double angle, double m[9])
{
    const double a[3] = {(double)axis.x, (double)axis.y, (double)axis.z};
    const double c = cos(angle), s = sin(angle);
    for (int column = 0; column < 3; column++) {
        for (int row = 0; row < 3; row++) {
            const int other = 3 - row - column;
            const double sign = (column + 1) % 3 == row ? 1.0 : -1.0;
            m[3 * column + row] =
                (1.0 - c) * a[row] * a[column] + (row == column ? c : sign * s * a[other % 3]);
        }
    }
}

static void transform(const double m[9], const double d[3], double out[3])
{
    for (int row = 0; row < 3; row++) {
        out[row] = m[row] * d[0] + m[3 + row] * d[1] + m[6 + row] * d[2];
    }
}

/// Σ c Y of all bands to 5.
static double value(const double *c, const double d[3])
{
    double y[ALPI_SH_LIMIT], sum = 0.0;
    alpi_sh_basis(5, d, y);
    for (int i = 0; i < ALPI_SH_LIMIT; i++) {
        sum += c[i] * y[i];
    }
    return sum;
}

static void check(const double m[9])
{
    double c[ALPI_SH_LIMIT], turned[ALPI_SH_LIMIT];
    alpi_sh_rotation rotation;
    for (int i = 0; i < ALPI_SH_LIMIT; i++) {
        c[i] = sin(3.0 * i + 1.0);
    }
    alpi_sh_rotation_set(&rotation, 5, m);
    alpi_sh_rotation_apply(&rotation, c, turned);
    for (int i = 0; i < 60; i++) {
        const double phi = 2.4 * i, z = 1.0 - (2.0 * i + 1.0) / 60.0, s = sqrt(1.0 - z * z);
        const double d[3] = {s * cos(phi), s * sin(phi), z};
        double there[3];
        transform(m, d, there);
        ASSERT_NEAR(value(turned, there), value(c, d), 1e-12);
    }
}

TEST(rotated_coefficients_are_the_rotated_function)
{
    double m[9];
    for (int i = 0; i < 30; i++) {
        turn(vec3_normalize_or(test_direction(i, 30), (vec3){0, 1, 0}), 0.2 * i, m);
        // The axis is rounded to float: make the matrix orthonormal to double again.
        double length = 0.0, dot = 0.0;
        for (int k = 0; k < 3; k++) {
            length += m[k] * m[k];
        }
        for (int k = 0; k < 3; k++) {
            m[k] /= sqrt(length);
            dot += m[k] * m[3 + k];
        }
        length = 0.0;
        for (int k = 0; k < 3; k++) {
            m[3 + k] -= dot * m[k];
            length += m[3 + k] * m[3 + k];
        }
        for (int k = 0; k < 3; k++) {
            m[3 + k] /= sqrt(length);
        }
        for (int k = 0; k < 3; k++) {
            m[6 + k] = m[(k + 1) % 3] * m[3 + (k + 2) % 3] - m[(k + 2) % 3] * m[3 + (k + 1) % 3];
        }
        check(m);
    }
}

TEST(quarter_turns_and_mirrors)
{
    check((const double[9]){0, 1, 0, -1, 0, 0, 0, 0, 1});
    check((const double[9]){0, 0, 1, 1, 0, 0, 0, 1, 0});
    check((const double[9]){-1, 0, 0, 0, 1, 0, 0, 0, 1});
    check((const double[9]){-1, 0, 0, 0, -1, 0, 0, 0, -1});
}

TEST(light_turns_with_the_matrix)
{
    // A light from +X, turned by 90° about +Y: x becomes −z.
    const float white[3] = {1.0f, 2.0f, 3.0f};
    const float matrix[9] = {0, 0, -1, 0, 1, 0, 1, 0, 0};
    alp_sh9 c = {{{0.0f}}}, expected = {{{0.0f}}};
    alp_sh_add_directional(&c, (const float[3]){1, 0, 0}, white);
    alp_sh_add_directional(&c, (const float[3]){0, 0.6f, 0.8f}, white);
    alp_sh_add_directional(&expected, (const float[3]){0, 0, -1}, white);
    alp_sh_add_directional(&expected, (const float[3]){0.8f, 0.6f, 0}, white);
    alp_sh_rotate(&c, matrix, &c);
    for (int i = 0; i < 27; i++) {
        ASSERT_NEAR(c.c[i / 3][i % 3], expected.c[i / 3][i % 3], 2e-6);
    }
}
