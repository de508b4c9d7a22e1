// SPDX-License-Identifier: MIT
// Nine spherical harmonics of three channels: radiance of a whole sphere of directions.
//
// The basis and its order are those of alpenglow/sh.h. Coefficients of radiance are
// c = ∫ L(ω) Y(ω) dω [W·m⁻²]. The irradiance of a plane with normal n is E(n) = Σ A_l c_lm Y_lm(n),
// with A = π, 2π/3, π/4.
// Based on: R. Ramamoorthi, P. Hanrahan. An Efficient Representation for Irradiance Environment
//           Maps. SIGGRAPH 2001.
#ifndef ALPI_SH_SH9_H
#define ALPI_SH_SH9_H

#include "base/vec.h"

#include <alpenglow/sh.h>
#include <alpenglow/shared_constants.h>

enum { ALPI_SH9_COUNT = 9, ALPI_SH4_COUNT = 4 };

/// Coefficients of radiance, unless the name says otherwise.
typedef alp_sh9 alpi_sh9;

/// The nine functions in a direction.
static inline void alpi_sh9_basis(vec3 unit, float basis[ALPI_SH9_COUNT])
{
    const float x = unit.x, y = unit.y, z = unit.z;
    basis[0] = (float)ALP_SH_Y0;
    basis[1] = (float)ALP_SH_Y1 * y;
    basis[2] = (float)ALP_SH_Y1 * z;
    basis[3] = (float)ALP_SH_Y1 * x;
    basis[4] = (float)ALP_SH_Y2 * x * y;
    basis[5] = (float)ALP_SH_Y2 * y * z;
    basis[6] = (float)ALP_SH_Y20 * (3.0f * z * z - 1.0f);
    basis[7] = (float)ALP_SH_Y2 * x * z;
    basis[8] = (float)ALP_SH_Y22 * (x * x - y * y);
}

/// A_l Y_lm(n): E = Σ weight · c.
static inline void alpi_sh9_irradiance_weights(vec3 normal, float weights[ALPI_SH9_COUNT])
{
    static const float cosine[ALPI_SH9_COUNT] = {
        (float)ALP_SH_A0, (float)ALP_SH_A1, (float)ALP_SH_A1, (float)ALP_SH_A1, (float)ALP_SH_A2,
        (float)ALP_SH_A2, (float)ALP_SH_A2, (float)ALP_SH_A2, (float)ALP_SH_A2};
    alpi_sh9_basis(normal, weights);
    for (int i = 0; i < ALPI_SH9_COUNT; i++) {
        weights[i] *= cosine[i];
    }
}

/// E [W·m⁻²] of a plane with this normal; may be below 0.
static inline vec3 alpi_sh9_irradiance(const alpi_sh9 *radiance, vec3 normal)
{
    float w[ALPI_SH9_COUNT];
    vec3 e = {0.0f, 0.0f, 0.0f};
    alpi_sh9_irradiance_weights(normal, w);
    for (int i = 0; i < ALPI_SH9_COUNT; i++) {
        e = vec3_mad(e, w[i], vec3_load(radiance->c[i]));
    }
    return e;
}

/// The same as the polynomial of the paper, with its constants c₁ to c₅.
vec3 alpi_sh9_irradiance_polynomial(const alpi_sh9 *radiance, vec3 normal);

/// Irradiance in the chosen way.
vec3 alpi_sh9_read(const alpi_sh9 *radiance, vec3 normal, alp_sh_reading reading);

/// Band l of a coefficient.
static inline int alpi_sh9_band(int index)
{
    return index == 0 ? 0 : index < ALPI_SH4_COUNT ? 1 : 2;
}

/// Weights of an ambient cube, +x −x +y −y +z −z: E(n) = Σ n_i² E(±axis i).
static inline void alpi_ambient_cube_weights(vec3 normal, float weights[6])
{
    const float axis[3] = {normal.x, normal.y, normal.z};
    for (int k = 0; k < 3; k++) {
        const float square = axis[k] * axis[k];
        weights[2 * k] = axis[k] > 0.0f ? square : 0.0f;
        weights[2 * k + 1] = axis[k] > 0.0f ? 0.0f : square;
    }
}

#endif
