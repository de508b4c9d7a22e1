// SPDX-License-Identifier: MIT
#ifndef ALPI_FILM_WHITE_BALANCE_H
#define ALPI_FILM_WHITE_BALANCE_H

/// A 3 × 3 matrix, row by row.
typedef struct alpi_matrix3 {
    double m[3][3];
} alpi_matrix3;

alpi_matrix3 alpi_matrix3_multiply(const alpi_matrix3 *a, const alpi_matrix3 *b);
void alpi_matrix3_apply(const alpi_matrix3 *a, const double in[3], double out[3]);

/// Linear Rec. 709 → CIE XYZ; white (1, 1, 1) is D65 with Y = 1.
alpi_matrix3 alpi_rgb_to_xyz(void);

/// Weights of red, green and blue in luminance Y.
void alpi_luminance_weights(double weights[3]);

/// CIE 1931 chromaticity of light of a colour temperature in [1000, 25000] K: black body below
/// 4000 K, daylight above 5000 K, between them mixed by spectra of equal luminance, as reference
/// light is in ANSI/IES TM-30.
void alpi_kelvin_chromaticity(double kelvin, double xy[2]);

/// Matrix on linear Rec. 709 that makes light of this chromaticity white, luminance kept.
alpi_matrix3 alpi_balance_for_chromaticity(const double xy[2]);

/// The same for light of this linear colour, with cone responses changed by a factor of `limit` at
/// most. Its luminance must be above 0.
alpi_matrix3 alpi_balance_for_colour(const double rgb[3], double limit);

#endif
