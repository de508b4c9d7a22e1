// SPDX-License-Identifier: MIT
// Irradiance as nᵗ M n: the matrix M of each channel, which a shader reads with two products.
// Based on: R. Ramamoorthi, P. Hanrahan. An Efficient Representation for Irradiance Environment
//           Maps. SIGGRAPH 2001, equation 12.
#include "sh/sh9.h"

void alp_sh_shader_vectors(const alp_sh9 *radiance, float vectors[12][4])
{
    for (int k = 0; k < 3; k++) {
        double c[ALPI_SH9_COUNT];
        for (int i = 0; i < ALPI_SH9_COUNT; i++) {
            c[i] = (double)radiance->c[i][k];
        }
        const double xy = ALP_SH_C1 * c[4], yz = ALP_SH_C1 * c[5], xz = ALP_SH_C1 * c[7];
        const double xx = ALP_SH_C1 * c[8], zz = ALP_SH_C3 * c[6];
        const double x = ALP_SH_C2 * c[3], y = ALP_SH_C2 * c[1], z = ALP_SH_C2 * c[2];
        const double one = ALP_SH_C4 * c[0] - ALP_SH_C5 * c[6];
        const double m[4][4] = {{xx, xy, xz, x}, {xy, -xx, yz, y}, {xz, yz, zz, z}, {x, y, z, one}};
        for (int i = 0; i < 16; i++) {
            vectors[4 * k + i / 4][i % 4] = (float)m[i / 4][i % 4];
        }
    }
}

void alp_sh_shader_irradiance(const float *vectors, const float normal[3], float irradiance[3])
{
    const float n[4] = {normal[0], normal[1], normal[2], 1.0f};
    for (int k = 0; k < 3; k++) {
        float e = 0.0f;
        for (int i = 0; i < 4; i++) {
            const float *column = vectors + 4 * (4 * (size_t)k + (size_t)i);
            e += n[i] * (column[0] * n[0] + column[1] * n[1] + column[2] * n[2] + column[3]);
        }
        irradiance[k] = e;
    }
}
