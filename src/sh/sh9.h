// SPDX-License-Identifier: MIT
// Nine spherical harmonics of three channels: radiance of a whole sphere of directions.
//
// Real basis, index l(l+1)+m, without the Condon–Shortley sign:
//
//     Y = .282095 | .488603 (y, z, x) | 1.092548 (xy, yz), .315392 (3z² − 1), 1.092548 xz,
//         .546274 (x² − y²)
//
// Coefficients of radiance are c = ∫ L(ω) Y(ω) dω [W·m⁻²]. The irradiance of a plane with normal n
// is E(n) = Σ A_l c_lm Y_lm(n), with A = π, 2π/3, π/4.
// Based on: R. Ramamoorthi, P. Hanrahan. An Efficient Representation for Irradiance Environment
//           Maps. SIGGRAPH 2001.
#ifndef ALPI_SH_SH9_H
#define ALPI_SH_SH9_H

#include "base/vec.h"

enum { ALPI_SH9_COUNT = 9, ALPI_SH4_COUNT = 4 };

/// Of radiance, unless the name says otherwise.
typedef struct alpi_sh9 {
    float c[ALPI_SH9_COUNT][3];
} alpi_sh9;

/// The nine functions in a direction.
static inline void alpi_sh9_basis(vec3 unit, float basis[ALPI_SH9_COUNT])
{
    const float x = unit.x, y = unit.y, z = unit.z;
    basis[0] = 0.28209479f;
    basis[1] = 0.48860251f * y;
    basis[2] = 0.48860251f * z;
    basis[3] = 0.48860251f * x;
    basis[4] = 1.0925484f * x * y;
    basis[5] = 1.0925484f * y * z;
    basis[6] = 0.31539157f * (3.0f * z * z - 1.0f);
    basis[7] = 1.0925484f * x * z;
    basis[8] = 0.54627422f * (x * x - y * y);
}

/// A_l Y_lm(n): E = Σ weight · c.
static inline void alpi_sh9_irradiance_weights(vec3 normal, float weights[ALPI_SH9_COUNT])
{
    static const float cosine[ALPI_SH9_COUNT] = {
        3.1415927f,  2.0943951f,  2.0943951f,  2.0943951f, 0.78539816f,
        0.78539816f, 0.78539816f, 0.78539816f, 0.78539816f};
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

#endif
