// SPDX-License-Identifier: MIT
// Rotation of real spherical harmonics: each band from the band before and from band 1.
#include "sh/rotation.h"

#include "sh/sh9.h"

/// Element (m, n) of a band, m and n in [−l, l].
static double element(const alpi_sh_rotation *r, int l, int m, int n)
{
    return r->bands[l][m + l][n + l];
}

/// The helper function P of the paper: row i of band 1 and row a of band l − 1.
static double combine(const alpi_sh_rotation *r, int i, int l, int a, int n)
{
    if (n == l) {
        return element(r, 1, i, 1) * element(r, l - 1, a, l - 1) -
               element(r, 1, i, -1) * element(r, l - 1, a, 1 - l);
    }
    if (n == -l) {
        return element(r, 1, i, 1) * element(r, l - 1, a, 1 - l) +
               element(r, 1, i, -1) * element(r, l - 1, a, l - 1);
    }
    return element(r, 1, i, 0) * element(r, l - 1, a, n);
}

static double term_v(const alpi_sh_rotation *r, int l, int m, int n)
{
    if (m == 0) {
        return combine(r, 1, l, 1, n) + combine(r, -1, l, -1, n);
    }
    if (m > 0) {
        const double first = combine(r, 1, l, m - 1, n) * (m == 1 ? sqrt(2.0) : 1.0);
        return m == 1 ? first : first - combine(r, -1, l, 1 - m, n);
    }
    const double last = combine(r, -1, l, -m - 1, n) * (m == -1 ? sqrt(2.0) : 1.0);
    return m == -1 ? last : combine(r, 1, l, m + 1, n) + last;
}

static double term_w(const alpi_sh_rotation *r, int l, int m, int n)
{
    return m > 0 ? combine(r, 1, l, m + 1, n) + combine(r, -1, l, -m - 1, n)
                 : combine(r, 1, l, m - 1, n) - combine(r, -1, l, 1 - m, n);
}

static double next_element(const alpi_sh_rotation *r, int l, int m, int n)
{
    const int size = m < 0 ? -m : m, zero = m == 0 ? 1 : 0;
    const double below = n == l || n == -l ? 2.0 * l * (2 * l - 1) : (double)((l + n) * (l - n));
    const double u = sqrt((l + m) * (l - m) / below);
    const double v = 0.5 * sqrt((1 + zero) * (l + size - 1) * (l + size) / below) * (1 - 2 * zero);
    const double w = -0.5 * sqrt((l - size - 1) * (l - size) / below) * (1 - zero);
    double sum = 0.0;
    sum += u != 0.0 ? u * combine(r, 0, l, m, n) : 0.0;
    sum += v != 0.0 ? v * term_v(r, l, m, n) : 0.0;
    sum += w != 0.0 ? w * term_w(r, l, m, n) : 0.0;
    return sum;
}

void alpi_sh_rotation_set(alpi_sh_rotation *rotation, int order, const double matrix[9])
{
    static const int axes[3] = {1, 2, 0}; // band 1 is y, z, x
    rotation->order = order;
    rotation->bands[0][0][0] = 1.0;
    for (int m = 0; m < 3 && order > 0; m++) {
        for (int n = 0; n < 3; n++) {
            rotation->bands[1][m][n] = matrix[3 * axes[n] + axes[m]];
        }
    }
    for (int l = 2; l <= order; l++) {
        for (int m = -l; m <= l; m++) {
            for (int n = -l; n <= l; n++) {
                rotation->bands[l][m + l][n + l] = next_element(rotation, l, m, n);
            }
        }
    }
}

void alpi_sh_rotation_apply(const alpi_sh_rotation *rotation, const double *c, double *turned)
{
    for (int l = 0; l <= rotation->order; l++) {
        for (int m = -l; m <= l; m++) {
            double sum = 0.0;
            for (int n = -l; n <= l; n++) {
                sum += element(rotation, l, m, n) * c[l * (l + 1) + n];
            }
            turned[l * (l + 1) + m] = sum;
        }
    }
}

void alp_sh_rotate(const alp_sh9 *radiance, const float matrix[9], alp_sh9 *rotated)
{
    double wide[9];
    alpi_sh_rotation rotation;
    for (int i = 0; i < 9; i++) {
        wide[i] = (double)matrix[i];
    }
    alpi_sh_rotation_set(&rotation, 2, wide);
    for (int k = 0; k < 3; k++) {
        double c[ALPI_SH9_COUNT], turned[ALPI_SH9_COUNT];
        for (int i = 0; i < ALPI_SH9_COUNT; i++) {
            c[i] = (double)radiance->c[i][k];
        }
        alpi_sh_rotation_apply(&rotation, c, turned);
        for (int i = 0; i < ALPI_SH9_COUNT; i++) {
            rotated->c[i][k] = (float)turned[i];
        }
    }
}
