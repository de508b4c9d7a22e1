// SPDX-License-Identifier: MIT
// White balance: colour temperature to chromaticity, and chromatic adaptation to D65.
// Based on: K. M. Lam. Metamerism and colour constancy. University of Bradford 1985 (the matrix, as
// in ICC.1:2022 annex E); CIE 15 (daylight); M. Krystek. An algorithm to calculate correlated
// colour temperature. Color Research & Application 10, 1985 (black body).
#include "film/white_balance.h"

#include <math.h>

/// ITU-R BT.709: chromaticities of red, green, blue, and of the white D65.
static const double PRIMARIES[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
static const double WHITE[2] = {0.3127, 0.3290};

/// XYZ → responses of the three kinds of cones, sharpened.
static const alpi_matrix3 BRADFORD = {
    {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};

// --- matrices ------------------------------------------------------------------------------------

alpi_matrix3 alpi_matrix3_multiply(const alpi_matrix3 *a, const alpi_matrix3 *b)
{
    alpi_matrix3 product;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            product.m[i][j] =
                a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j];
        }
    }
    return product;
}

void alpi_matrix3_apply(const alpi_matrix3 *a, const double in[3], double out[3])
{
    const double v[3] = {in[0], in[1], in[2]};
    for (int i = 0; i < 3; i++) {
        out[i] = a->m[i][0] * v[0] + a->m[i][1] * v[1] + a->m[i][2] * v[2];
    }
}

/// By cofactors; only for matrices that have an inverse.
static alpi_matrix3 invert(const alpi_matrix3 *a)
{
    alpi_matrix3 inverse;
    double determinant = 0.0;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            int r0 = (j + 1) % 3, r1 = (j + 2) % 3, c0 = (i + 1) % 3, c1 = (i + 2) % 3;
            inverse.m[i][j] = a->m[r0][c0] * a->m[r1][c1] - a->m[r0][c1] * a->m[r1][c0];
        }
        determinant += a->m[0][i] * inverse.m[i][0];
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            inverse.m[i][j] /= determinant;
        }
    }
    return inverse;
}

/// XYZ of a chromaticity with Y = 1.
static void unit_xyz(const double xy[2], double xyz[3])
{
    xyz[0] = xy[0] / xy[1];
    xyz[1] = 1.0;
    xyz[2] = (1.0 - xy[0] - xy[1]) / xy[1];
}

alpi_matrix3 alpi_rgb_to_xyz(void)
{
    alpi_matrix3 columns;
    for (int k = 0; k < 3; k++) {
        double xyz[3];
        unit_xyz(PRIMARIES[k], xyz);
        for (int i = 0; i < 3; i++) {
            columns.m[i][k] = xyz[i];
        }
    }
    double white[3], amounts[3];
    unit_xyz(WHITE, white);
    const alpi_matrix3 inverse = invert(&columns);
    alpi_matrix3_apply(&inverse, white, amounts);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) {
            columns.m[i][k] *= amounts[k];
        }
    }
    return columns;
}

void alpi_luminance_weights(double weights[3])
{
    const alpi_matrix3 xyz = alpi_rgb_to_xyz();
    for (int k = 0; k < 3; k++) {
        weights[k] = xyz.m[1][k];
    }
}

// --- colour temperature --------------------------------------------------------------------------

/// Krystek's fit, 1000 to 15000 K, good to 1e-4 of CIE 1960 (u, v).
static void black_body(double t, double xy[2])
{
    const double u = ((1.28641212e-7 * t + 1.54118254e-4) * t + 0.860117757) /
                     ((7.08145163e-7 * t + 8.42420235e-4) * t + 1.0);
    const double v = ((4.20481691e-8 * t + 4.22806245e-5) * t + 0.317398726) /
                     ((1.61456053e-7 * t - 2.89741816e-5) * t + 1.0);
    xy[0] = 3.0 * u / (2.0 * u - 8.0 * v + 4.0);
    xy[1] = 2.0 * v / (2.0 * u - 8.0 * v + 4.0);
}

/// CIE daylight, 4000 to 25000 K.
static void daylight(double t, double xy[2])
{
    const double x = t < 7000.0 ? ((-4.6070e9 / t + 2.9678e6) / t + 0.09911e3) / t + 0.244063
                                : ((-2.0064e9 / t + 1.9018e6) / t + 0.24748e3) / t + 0.237040;
    xy[0] = x;
    xy[1] = (-3.000 * x + 2.870) * x - 0.275;
}

void alpi_kelvin_chromaticity(double kelvin, double xy[2])
{
    double body[2], day[2], body_xyz[3], day_xyz[3];
    const double share = fmin(fmax((kelvin - 4000.0) / 1000.0, 0.0), 1.0); // of daylight
    black_body(fmin(kelvin, 5000.0), body);
    daylight(fmax(kelvin, 4000.0), day);
    unit_xyz(body, body_xyz);
    unit_xyz(day, day_xyz);
    double sum = 0.0;
    for (int i = 0; i < 3; i++) {
        body_xyz[i] += share * (day_xyz[i] - body_xyz[i]);
        sum += body_xyz[i];
    }
    xy[0] = body_xyz[0] / sum;
    xy[1] = body_xyz[1] / sum;
}

// --- adaptation ----------------------------------------------------------------------------------

/// Each cone response is multiplied by white's over that of the light, within [1/limit, limit].
static alpi_matrix3 balance(const double light_xyz[3], double limit)
{
    double white_xyz[3], white[3], light[3];
    unit_xyz(WHITE, white_xyz);
    alpi_matrix3_apply(&BRADFORD, white_xyz, white);
    alpi_matrix3_apply(&BRADFORD, light_xyz, light);
    const alpi_matrix3 xyz = alpi_rgb_to_xyz();
    const alpi_matrix3 cones = alpi_matrix3_multiply(&BRADFORD, &xyz);
    alpi_matrix3 scaled = cones;
    for (int i = 0; i < 3; i++) {
        // A colour outside all light may have no response, or a negative one.
        double gain = light[i] > 0.0 ? white[i] / light[i] : limit;
        gain = fmin(fmax(gain, 1.0 / limit), limit);
        for (int j = 0; j < 3; j++) {
            scaled.m[i][j] *= gain;
        }
    }
    const alpi_matrix3 back = invert(&cones);
    return alpi_matrix3_multiply(&back, &scaled);
}

alpi_matrix3 alpi_balance_for_chromaticity(const double xy[2])
{
    double light[3];
    unit_xyz(xy, light);
    return balance(light, 1e6); // no light of a temperature comes near that
}

alpi_matrix3 alpi_balance_for_colour(const double rgb[3], double limit)
{
    double light[3];
    const alpi_matrix3 xyz = alpi_rgb_to_xyz();
    alpi_matrix3_apply(&xyz, rgb, light);
    const double luminance = light[1];
    for (int i = 0; i < 3; i++) {
        light[i] /= luminance;
    }
    return balance(light, limit);
}
