// SPDX-License-Identifier: MIT
// The basis: orthonormality to band 5, agreement of its forms, constants.
#include "sh_directions.h"
#include "test_support.h"

#include "sh/basis.h"

#include <stdlib.h>

enum { COUNT = ALPI_SH_LIMIT, AZIMUTHS = 16, POLARS = 8 };

/// Gauss–Legendre nodes of eight points: exact for polynomials up to degree 15.
static const double nodes[POLARS / 2] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                         0.9602898564975363};
static const double weights[POLARS / 2] = {0.3626837833783620, 0.3137066458778873,
                                           0.2223810344533745, 0.1012285362903763};

TEST(bands_to_5_are_orthonormal)
{
    static double gram[COUNT][COUNT];
    memset(gram, 0, sizeof gram);
    for (int p = 0; p < POLARS; p++) {
        const double z = p < POLARS / 2 ? nodes[p] : -nodes[p - POLARS / 2];
        const double weight = weights[p % (POLARS / 2)] * 2.0 * ALPI_PI / AZIMUTHS;
        for (int a = 0; a < AZIMUTHS; a++) {
            const double phi = 2.0 * ALPI_PI * (a + 0.25) / AZIMUTHS, s = sqrt(1.0 - z * z);
            double y[COUNT];
            alpi_sh_basis(5, (const double[3]){s * cos(phi), s * sin(phi), z}, y);
            for (int i = 0; i < COUNT; i++) {
                for (int j = 0; j < COUNT; j++) {
                    gram[i][j] += weight * y[i] * y[j];
                }
            }
        }
    }
    for (int i = 0; i < COUNT; i++) {
        for (int j = 0; j < COUNT; j++) {
            ASSERT_NEAR(gram[i][j], i == j ? 1.0 : 0.0, 1e-13);
        }
    }
}

TEST(nine_functions_are_those_of_any_band)
{
    for (int i = 0; i < 500; i++) {
        const vec3 d = test_direction(i, 500);
        double any[9], four[4];
        float nine[9];
        alpi_sh_basis(2, (const double[3]){(double)d.x, (double)d.y, (double)d.z}, any);
        alpi_sh9_basis(d, nine);
        alpi_sh1_basis(d, four);
        for (int k = 0; k < 9; k++) {
            ASSERT_NEAR(nine[k], any[k], 3e-7);
        }
        for (int k = 0; k < 4; k++) {
            ASSERT_NEAR(four[k], any[k], 1e-15);
        }
    }
}

TEST(cosine_factors_are_integrals)
{
    // 2π ∫ z P_l(z) dz over [0, 1], by the function of m = 0 on a fine grid
    enum { STEPS = 20000 };
    for (int l = 0; l <= 5; l++) {
        double sum = 0.0;
        for (int i = 0; i < STEPS; i++) {
            const double z = (i + 0.5) / STEPS;
            double y[COUNT];
            alpi_sh_basis(5, (const double[3]){sqrt(1.0 - z * z), 0.0, z}, y);
            sum += 2.0 * ALPI_PI * z * y[l * (l + 1)] / sqrt((2 * l + 1) / (4.0 * ALPI_PI)) / STEPS;
        }
        ASSERT_NEAR(alpi_sh_cosine_factor(l), sum, 1e-7);
    }
    ASSERT_NEAR(alpi_sh_cosine_factor(4), -ALPI_PI / 24.0, 1e-15);
}

TEST(constants_are_products)
{
    ASSERT_NEAR(ALP_SH_Y0, sqrt(1.0 / (4.0 * ALPI_PI)), 1e-16);
    ASSERT_NEAR(ALP_SH_Y1, sqrt(3.0 / (4.0 * ALPI_PI)), 1e-15);
    ASSERT_NEAR(ALP_SH_Y2, sqrt(15.0 / (4.0 * ALPI_PI)), 1e-15);
    ASSERT_NEAR(ALP_SH_Y20, sqrt(5.0 / (16.0 * ALPI_PI)), 1e-15);
    ASSERT_NEAR(ALP_SH_Y22, sqrt(15.0 / (16.0 * ALPI_PI)), 1e-15);
    ASSERT_NEAR(ALP_SH_A0, alpi_sh_cosine_factor(0), 1e-15);
    ASSERT_NEAR(ALP_SH_A1, alpi_sh_cosine_factor(1), 1e-15);
    ASSERT_NEAR(ALP_SH_A2, alpi_sh_cosine_factor(2), 1e-15);
    ASSERT_NEAR(ALP_SH_C1, 0.429043, 5e-7);
    ASSERT_NEAR(ALP_SH_C2, 0.511663, 5e-7);
    ASSERT_NEAR(ALP_SH_C3, 0.743124, 5e-7);
    ASSERT_NEAR(ALP_SH_C4, 0.886227, 5e-7);
    ASSERT_NEAR(ALP_SH_C5, 0.247708, 5e-7);
    ASSERT_NEAR(ALP_SH_C1, ALP_SH_A2 * ALP_SH_Y22, 1e-15);
    ASSERT_NEAR(ALP_SH_C2, ALP_SH_A1 * ALP_SH_Y1 / 2.0, 1e-15);
    ASSERT_NEAR(ALP_SH_C3, 3.0 * ALP_SH_A2 * ALP_SH_Y20, 1e-15);
    ASSERT_NEAR(ALP_SH_C4, ALP_SH_A0 * ALP_SH_Y0, 1e-15);
    ASSERT_NEAR(ALP_SH_C5, ALP_SH_A2 * ALP_SH_Y20, 1e-15);
}

TEST(shared_constants_are_a_shader_too)
{
    // Comments, and directives without anything that C alone knows.
    size_t size = 0;
    char *text =
        (char *)test_read_file(ALP_SOURCE_FOLDER "/include/alpenglow/shared_constants.h", &size);
    int defines = 0;
    for (char *line = text; line < text + size;) {
        char *end = memchr(line, '\n', (size_t)(text + size - line));
        assert_non_null(end);
        *end = '\0';
        const bool is_define = strncmp(line, "#define ALP", 11) == 0;
        assert_true(is_define || *line == '\0' || strncmp(line, "//", 2) == 0 ||
                    strncmp(line, "#ifndef", 7) == 0 || strcmp(line, "#endif") == 0);
        defines += is_define ? 1 : 0;
        line = end + 1;
    }
    assert_true(defines >= 14);
    free(text);
}
