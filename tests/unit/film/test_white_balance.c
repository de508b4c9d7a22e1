// SPDX-License-Identifier: MIT
// White balance: light of the temperature named becomes white, and white light stays.
#include "film_pictures.h"

#include "film/white_balance.h"

#include <math.h>

static const double D65[2] = {0.3127, 0.3290};

static double determinant(const alpi_matrix3 *a)
{
    return a->m[0][0] * (a->m[1][1] * a->m[2][2] - a->m[1][2] * a->m[2][1]) -
           a->m[0][1] * (a->m[1][0] * a->m[2][2] - a->m[1][2] * a->m[2][0]) +
           a->m[0][2] * (a->m[1][0] * a->m[2][1] - a->m[1][1] * a->m[2][0]);
}

/// Linear Rec. 709 of light of a chromaticity, luminance 1, by Cramer's rule; parts may be
/// negative.
static void light_of(const double xy[2], double rgb[3])
{
    const double xyz[3] = {xy[0] / xy[1], 1.0, (1.0 - xy[0] - xy[1]) / xy[1]};
    const alpi_matrix3 matrix = alpi_rgb_to_xyz();
    for (int k = 0; k < 3; k++) {
        alpi_matrix3 replaced = matrix;
        for (int i = 0; i < 3; i++) {
            replaced.m[i][k] = xyz[i];
        }
        rgb[k] = determinant(&replaced) / determinant(&matrix);
    }
}

TEST(primaries_are_those_of_rec_709)
{
    // IEC 61966-2-1, four digits
    const double expected[3][3] = {
        {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    const alpi_matrix3 xyz = alpi_rgb_to_xyz();
    double weights[3];
    alpi_luminance_weights(weights);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            ASSERT_NEAR(xyz.m[i][j], expected[i][j], 5.1e-5);
        }
        assert_true(weights[i] == xyz.m[1][i]);
    }
    ASSERT_NEAR(weights[0] + weights[1] + weights[2], 1.0, 1e-14);
}

TEST(temperatures_have_their_colors)
{
    // CIE 15: illuminants A, D55, D65, D75 (their temperatures with c2 = 1.4388e-2 m K), and the
    // black body of 2000 K by Planck's law. The daylight locus passes the D illuminants at 2e-4;
    // 1e-4 of (u, v), as good as the fit of the black body is, is up to 4e-4 of (x, y).
    const double known[][3] = {{2856.0, 0.44758, 0.40745},
                               {2000.0, 0.52669, 0.41331},
                               {5503.0, 0.33242, 0.34743},
                               {6504.0, 0.31271, 0.32902},
                               {7504.0, 0.29902, 0.31485}};
    for (int i = 0; i < 5; i++) {
        double xy[2];
        alpi_kelvin_chromaticity(known[i][0], xy);
        ASSERT_NEAR(xy[0], known[i][1], 4e-4);
        ASSERT_NEAR(xy[1], known[i][2], 4e-4);
    }
}

TEST(temperatures_have_no_seams)
{
    double before[2];
    alpi_kelvin_chromaticity(1000.0, before);
    for (double kelvin = 1001.0; kelvin <= 25000.0; kelvin += 1.0) {
        double xy[2];
        alpi_kelvin_chromaticity(kelvin, xy);
        // The steepest kelvin, at 1000 K, changes x by 1.4e-4; a fit's joint is not worse. Warmer
        // is always redder.
        assert_true(xy[0] < before[0] && before[0] - xy[0] < 2e-4);
        assert_true(fabs(xy[1] - before[1]) < 2e-4);
        before[0] = xy[0];
        before[1] = xy[1];
    }
}

TEST(light_of_a_temperature_becomes_white)
{
    for (double kelvin = 1000.0; kelvin <= 25000.0; kelvin *= 1.07) {
        double xy[2], rgb[3];
        alpi_kelvin_chromaticity(kelvin, xy);
        light_of(xy, rgb);
        const alpi_matrix3 balance = alpi_balance_for_chromaticity(xy);
        alpi_matrix3_apply(&balance, rgb, rgb);
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(rgb[k], 1.0, 1e-12); // rounding, of which blue is amplified most
        }
    }
}

TEST(d65_stays_as_it_is)
{
    double xy[2];
    alpi_kelvin_chromaticity(6504.0, xy);
    const alpi_matrix3 exact = alpi_balance_for_chromaticity(D65);
    const alpi_matrix3 named = alpi_balance_for_chromaticity(xy);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            ASSERT_NEAR(exact.m[i][j], i == j, 1e-14);
            // CIE's daylight locus passes D65 at 1.2e-4 in y
            ASSERT_NEAR(named.m[i][j], i == j, 1e-3);
        }
    }
}

TEST(adaptation_is_by_bradford)
{
    // B. Lindbloom, Chromatic Adaptation: XYZ under A → XYZ under D65, by Bradford's matrix. His
    // D65 has Z = 1.08883, and that of Rec. 709 1.08906: 2.1e-4 of Z, his A (of 5 digits) 5e-5.
    const alpi_matrix3 published = {{{0.8446965, -0.1179225, 0.3948108},
                                     {-0.1366303, 1.1041226, 0.1291718},
                                     {0.0798489, -0.1348999, 3.1924009}}};
    const double a[2] = {1.09850 / 2.45435, 1.0 / 2.45435};
    const alpi_matrix3 balance = alpi_balance_for_chromaticity(a), xyz = alpi_rgb_to_xyz();
    for (int k = 0; k < 3; k++) {
        double expected[3] = {k == 0, k == 1, k == 2}, found[3] = {k == 0, k == 1, k == 2};
        alpi_matrix3_apply(&xyz, expected, expected);
        alpi_matrix3_apply(&published, expected, expected);
        alpi_matrix3_apply(&balance, found, found);
        alpi_matrix3_apply(&xyz, found, found);
        for (int i = 0; i < 3; i++) {
            ASSERT_NEAR(found[i], expected[i], 2.6e-4 * fmax(1.0, expected[i]));
        }
    }
}

TEST(luminance_of_the_light_is_kept)
{
    const double color[3] = {0.9, 0.4, 0.2};
    double weights[3], out[3];
    alpi_luminance_weights(weights);
    const alpi_matrix3 balance = alpi_balance_for_colour(color, 4.0);
    alpi_matrix3_apply(&balance, color, out);
    double luminance = color[0] * weights[0] + color[1] * weights[1] + color[2] * weights[2];
    for (int k = 0; k < 3; k++) {
        ASSERT_NEAR(out[k], luminance, 1e-14);
    }
}

TEST(gains_are_limited)
{
    const double red[3] = {1.0, 0.0, 0.0};
    const alpi_matrix3 balance = alpi_balance_for_colour(red, 4.0);
    double out[3];
    alpi_matrix3_apply(&balance, red, out);
    assert_true(out[0] > out[1] && out[0] > out[2]); // still red
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            assert_true(isfinite(balance.m[i][j]) && fabs(balance.m[i][j]) < 8.0);
        }
    }
}

TEST_WITH_CONTEXT(a_lamp_develops_grey, 1)
{
    alp_film_options options = alp_film_options_default();
    for (int automatic = 0; automatic < 2; automatic++) {
        double xy[2], rgb[3];
        alpi_kelvin_chromaticity(3000.0, xy);
        light_of(xy, rgb);
        float values[12];
        for (int i = 0; i < 12; i++) {
            values[i] = (float)(rgb[i % 3] * 0.21586); // luminance of byte 128
        }
        options.white_balance = automatic ? ALP_WHITE_BALANCE_AUTO : ALP_WHITE_BALANCE_KELVIN;
        options.kelvin = 3000.0f;
        uint8_t *bytes = developed(context, picture(context, 2, 2, 3, values), &options, NULL);
        for (int i = 0; i < 12; i++) {
            assert_int_equal(bytes[i], 128);
        }
        free(bytes);
    }
}
