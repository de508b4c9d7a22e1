// SPDX-License-Identifier: MIT
// Real spherical harmonics of any band:
//
//     Y_lm = K_lm P_lm(z) / s^|m| · (Re or √2 Re or √2 Im of (x + iy)^|m|),   s² = x² + y²
//
// P_lm / s^m is a polynomial in z, so the poles need no care. Re goes with m ≥ 0, Im with m < 0.
#include "sh/basis.h"

/// √((2l+1)/4π · (l−m)!/(l+m)!), and √2 times as much for m > 0.
static double normalization(int l, int m)
{
    double ratio = 1.0;
    for (int i = l - m + 1; i <= l + m; i++) {
        ratio /= i;
    }
    return sqrt((m > 0 ? 2.0 : 1.0) * (2 * l + 1) / (4.0 * ALPI_PI) * ratio);
}

/// The functions of ±m in all bands, from P_mm = (2m−1)!! and the recurrence in l.
static void fill_order(int order, int m, double z, double real, double imaginary, double *values)
{
    double before = 0.0, now = 1.0;
    for (int i = 1; i <= m; i++) {
        now *= 2 * i - 1;
    }
    for (int l = m; l <= order; l++) {
        const double scaled = normalization(l, m) * now;
        values[l * (l + 1) + m] = scaled * real;
        if (m > 0) {
            values[l * (l + 1) - m] = scaled * imaginary;
        }
        const double next = ((2 * l + 1) * z * now - (l + m) * before) / (l + 1 - m);
        before = now;
        now = next;
    }
}

void alpi_sh_basis(int order, const double unit[3], double *values)
{
    double real = 1.0, imaginary = 0.0;
    for (int m = 0; m <= order; m++) {
        fill_order(order, m, unit[2], real, imaginary, values);
        const double turned = real * unit[0] - imaginary * unit[1];
        imaginary = real * unit[1] + imaginary * unit[0];
        real = turned;
    }
}

double alpi_sh_cosine_factor(int band)
{
    if (band % 2 != 0) {
        return band == 1 ? 2.0 * ALPI_PI / 3.0 : 0.0;
    }
    double factor = ALPI_PI; // of even l: 2π (−1)^(l/2−1) / ((l+2)(l−1)) · l! / (2^l (l/2)!²)
    for (int l = 2; l <= band; l += 2) {
        factor *= l == 2 ? 0.25 : -(double)(l - 3) / (l + 2);
    }
    return factor;
}
