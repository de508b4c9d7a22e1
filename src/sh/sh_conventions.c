// SPDX-License-Identifier: MIT
// The numbers that other programs store for the same light. All but the ambient cube multiply each
// coefficient by a factor of its own and keep the order.
#include "sh/sh9.h"

enum { CUBE_SIDES = 6 };

#define LAMBERT0 (ALP_SH_A0 * ALP_SH_Y0 / ALPI_PI)
#define LAMBERT1 (ALP_SH_A1 * ALP_SH_Y1 / ALPI_PI)
#define LAMBERT2 (ALP_SH_A2 / ALPI_PI)

/// E/π as a polynomial: A_l and the factor of the basis are folded in.
#define POLYNOMIAL                                                                                 \
    {                                                                                              \
        LAMBERT0, LAMBERT1, LAMBERT1, LAMBERT1, LAMBERT2 *ALP_SH_Y2, LAMBERT2 *ALP_SH_Y2,          \
            LAMBERT2 *ALP_SH_Y20, LAMBERT2 *ALP_SH_Y2, LAMBERT2 *ALP_SH_Y22                        \
    }

static const double factors[][ALPI_SH9_COUNT] = {
    [ALP_SH_THREE] = {1, 1, 1, 1, 1, 1, 1, 1, 1},
    [ALP_SH_FILAMENT] = POLYNOMIAL,
    [ALP_SH_GLTF] = {ALP_SH_A0, -ALP_SH_A1, ALP_SH_A1, -ALP_SH_A1, ALP_SH_A2, -ALP_SH_A2, ALP_SH_A2,
                     -ALP_SH_A2, ALP_SH_A2},
    [ALP_SH_GODOT] = {1 / ALPI_PI, 1 / ALPI_PI, 1 / ALPI_PI, 1 / ALPI_PI, 1 / ALPI_PI, 1 / ALPI_PI,
                      1 / ALPI_PI, 1 / ALPI_PI, 1 / ALPI_PI},
    [ALP_SH_UNITY] = POLYNOMIAL,
};

/// Direction of a row of an ambient cube.
static vec3 side(int row)
{
    const float sign = row % 2 == 0 ? 1.0f : -1.0f;
    return (vec3){row / 2 == 0 ? sign : 0.0f, row / 2 == 1 ? sign : 0.0f,
                  row / 2 == 2 ? sign : 0.0f};
}

uint32_t alp_sh_row_count(alp_sh_convention convention)
{
    return (unsigned)convention > ALP_SH_AMBIENT_CUBE ? 0
           : convention == ALP_SH_AMBIENT_CUBE        ? CUBE_SIDES
                                                      : ALPI_SH9_COUNT;
}

alp_result alp_sh_convert(const alp_sh9 *radiance, alp_sh_convention convention, float values[][3])
{
    const uint32_t rows = alp_sh_row_count(convention);
    if (radiance == NULL || values == NULL || rows == 0) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    for (uint32_t i = 0; i < rows; i++) {
        if (convention == ALP_SH_AMBIENT_CUBE) {
            vec3_store(values[i], alpi_sh9_read(radiance, side((int)i), ALP_SH_CLAMPED));
            continue;
        }
        for (int k = 0; k < 3; k++) {
            values[i][k] = (float)(factors[convention][i] * (double)radiance->c[i][k]);
        }
    }
    return ALP_OK;
}

/// With P and N the values of opposite sides: P − N = 2 A₁ Y₁ c₁. The means (P + N) / 2 are
/// m = A₀ Y₀ c₀ + A₂ (band 2), and band 2 sums to 0 over the three axes.
static void from_cube(const float *cube, int k, alp_sh9 *radiance)
{
    double mean[3], change[3];
    for (int axis = 0; axis < 3; axis++) {
        const double positive = (double)cube[6 * axis + k];
        const double negative = (double)cube[6 * axis + 3 + k];
        mean[axis] = 0.5 * (positive + negative);
        change[axis] = 0.5 * (positive - negative) / (ALP_SH_A1 * ALP_SH_Y1);
    }
    const double all = (mean[0] + mean[1] + mean[2]) / 3.0;
    const double c[ALPI_SH9_COUNT] = {all / (ALP_SH_A0 * ALP_SH_Y0),
                                      change[1],
                                      change[2],
                                      change[0],
                                      0.0,
                                      0.0,
                                      (mean[2] - all) / (2.0 * ALP_SH_A2 * ALP_SH_Y20),
                                      0.0,
                                      (mean[0] - mean[1]) / (2.0 * ALP_SH_A2 * ALP_SH_Y22)};
    for (int i = 0; i < ALPI_SH9_COUNT; i++) {
        radiance->c[i][k] = (float)c[i];
    }
}

alp_result alp_sh_from(alp_sh_convention convention, const float *values, alp_sh9 *radiance)
{
    if (radiance == NULL || values == NULL || alp_sh_row_count(convention) == 0) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    for (int k = 0; k < 3; k++) {
        if (convention == ALP_SH_AMBIENT_CUBE) {
            from_cube(values, k, radiance);
            continue;
        }
        for (int i = 0; i < ALPI_SH9_COUNT; i++) {
            radiance->c[i][k] = (float)((double)values[3 * i + k] / factors[convention][i]);
        }
    }
    return ALP_OK;
}

void alp_sh_ambient_cube_irradiance(const float *cube, const float normal[3], float irradiance[3])
{
    for (int k = 0; k < 3; k++) {
        float e = 0.0f;
        for (int axis = 0; axis < 3; axis++) {
            const int row = 2 * axis + (normal[axis] < 0.0f ? 1 : 0);
            e += normal[axis] * normal[axis] * cube[3 * row + k];
        }
        irradiance[k] = e;
    }
}
