// SPDX-License-Identifier: MIT
// Coefficients of analytic lights. A light with an axis d that is L(ω) = f(ω·d) has
//
//     c_lm = λ_l Y_lm(d),   λ_l = 2π ∫ f(z) P_l(z) dz over [−1, 1]
#include "sh/sh9.h"

static void add_zonal(alp_sh9 *radiance, const float direction[3], const double lambda[3],
                      const float color[3])
{
    float basis[ALPI_SH9_COUNT];
    alpi_sh9_basis(vec3_load(direction), basis);
    for (int i = 0; i < ALPI_SH9_COUNT; i++) {
        const double factor = lambda[alpi_sh9_band(i)] * (double)basis[i];
        for (int k = 0; k < 3; k++) {
            radiance->c[i][k] = (float)((double)radiance->c[i][k] + factor * (double)color[k]);
        }
    }
}

void alp_sh_add_directional(alp_sh9 *radiance, const float direction[3], const float irradiance[3])
{
    add_zonal(radiance, direction, (const double[3]){1.0, 1.0, 1.0}, irradiance);
}

void alp_sh_add_point(alp_sh9 *radiance, const float offset[3], const float intensity[3])
{
    const double x = (double)offset[0], y = (double)offset[1], z = (double)offset[2];
    const double square = x * x + y * y + z * z, length = sqrt(square);
    if (length > 0.0) {
        const float direction[3] = {(float)(x / length), (float)(y / length), (float)(z / length)};
        const double factor = 1.0 / square;
        add_zonal(radiance, direction, (const double[3]){factor, factor, factor}, intensity);
    }
}

void alp_sh_add_disk(alp_sh9 *radiance, const float direction[3], double half_angle,
                     const float disk[3])
{
    const double angle = fmax(0.0, fmin(half_angle, ALPI_PI));
    const double cosine = cos(angle), sine = sin(angle), small = sin(0.5 * angle);
    const double lambda[3] = {4.0 * ALPI_PI * small * small, ALPI_PI * sine * sine,
                              ALPI_PI * cosine * sine * sine};
    add_zonal(radiance, direction, lambda, disk);
}

void alp_sh_add_hemisphere(alp_sh9 *radiance, const float direction[3], const float up[3],
                           const float down[3])
{
    const float opposite[3] = {-direction[0], -direction[1], -direction[2]};
    const double lambda[3] = {2.0 * ALPI_PI, ALPI_PI, 0.0};
    add_zonal(radiance, direction, lambda, up);
    add_zonal(radiance, opposite, lambda, down);
}
