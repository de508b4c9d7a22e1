// SPDX-License-Identifier: MIT
// Read-out, windows and cosine products of nine coefficients.
#include "sh/sh9.h"

#include "sh/rotation.h"

// --- irradiance ----------------------------------------------------------------------------------

vec3 alpi_sh9_irradiance_polynomial(const alpi_sh9 *radiance, vec3 n)
{
    const float c1 = (float)ALP_SH_C1, c2 = (float)ALP_SH_C2, c3 = (float)ALP_SH_C3;
    const float c4 = (float)ALP_SH_C4, c5 = (float)ALP_SH_C5;
    const float weights[ALPI_SH9_COUNT] = {c4,
                                           2.0f * c2 * n.y,
                                           2.0f * c2 * n.z,
                                           2.0f * c2 * n.x,
                                           2.0f * c1 * n.x * n.y,
                                           2.0f * c1 * n.y * n.z,
                                           c3 * n.z * n.z - c5,
                                           2.0f * c1 * n.x * n.z,
                                           c1 * (n.x * n.x - n.y * n.y)};
    vec3 e = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < ALPI_SH9_COUNT; i++) {
        e = vec3_mad(e, weights[i], vec3_load(radiance->c[i]));
    }
    return e;
}

/// ALP_SH_TWO_BANDS of one channel.
static float read_two_bands(const alpi_sh9 *radiance, int channel, vec3 n)
{
    const double c0 = (double)radiance->c[0][channel];
    const double y = (double)radiance->c[1][channel], z = (double)radiance->c[2][channel];
    const double x = (double)radiance->c[3][channel];
    const double length = sqrt(x * x + y * y + z * z);
    if (!(c0 > 0.0)) {
        return 0.0f;
    }
    const double r = fmin(length / (sqrt(3.0) * c0), 1.0);
    const double along = x * (double)n.x + y * (double)n.y + z * (double)n.z;
    const double cosine = length > 0.0 ? fmax(-1.0, fmin(along / length, 1.0)) : 0.0;
    const double p = 1.0 + 2.0 * r, a = (1.0 - r) / (1.0 + r);
    return (float)(ALP_SH_C4 * c0 * (a + (1.0 - a) * (p + 1.0) * pow(0.5 + 0.5 * cosine, p)));
}

vec3 alpi_sh9_read(const alpi_sh9 *radiance, vec3 normal, alp_sh_reading reading)
{
    if (reading == ALP_SH_TWO_BANDS) {
        return (vec3){read_two_bands(radiance, 0, normal), read_two_bands(radiance, 1, normal),
                      read_two_bands(radiance, 2, normal)};
    }
    const vec3 e = alpi_sh9_irradiance(radiance, normal);
    return reading == ALP_SH_LINEAR ? e : vec3_max(e, (vec3){0.0f, 0.0f, 0.0f});
}

void alp_sh_irradiance(const alp_sh9 *radiance, const float normal[3], alp_sh_reading reading,
                       float irradiance[3])
{
    vec3_store(irradiance, alpi_sh9_read(radiance, vec3_load(normal), reading));
}

// --- windows -------------------------------------------------------------------------------------

static double window_factor(alp_sh_window_kind kind, double width, int band)
{
    if (band == 0) {
        return 1.0;
    }
    if (!(band < width)) {
        return 0.0;
    }
    const double x = ALPI_PI * band / width;
    const double sinc = sin(x) / x;
    return kind == ALP_SH_HANNING ? 0.5 + 0.5 * cos(x) : sinc * sinc * sinc * sinc;
}

void alp_sh_window(alp_sh9 *radiance, alp_sh_window_kind kind, double width)
{
    for (int i = 0; i < ALPI_SH9_COUNT; i++) {
        const float factor = (float)window_factor(kind, width, alpi_sh9_band(i));
        for (int k = 0; k < 3; k++) {
            radiance->c[i][k] *= factor;
        }
    }
}

// --- the product with a cosine lobe --------------------------------------------------------------

/// ∫ Y_i Y_j max(0, z) dω: only functions of one m meet.
static void multiply_lobe_of_z(double c[ALPI_SH9_COUNT])
{
    const double root3 = sqrt(3.0), root5 = sqrt(5.0), root15 = sqrt(15.0);
    const double y = c[1], z = c[2], x = c[3], c0 = c[0], c6 = c[6];
    c[0] = c0 / 4.0 + z * root3 / 6.0 + c6 * root5 / 16.0;
    c[2] = c0 * root3 / 6.0 + z * 3.0 / 8.0 + c6 * root15 / 15.0;
    c[6] = c0 * root5 / 16.0 + z * root15 / 15.0 + c6 * 5.0 / 16.0;
    c[1] = y * 3.0 / 16.0 + c[5] * root5 / 10.0;
    c[5] = y * root5 / 10.0 + c[5] * 5.0 / 16.0;
    c[3] = x * 3.0 / 16.0 + c[7] * root5 / 10.0;
    c[7] = x * root5 / 10.0 + c[7] * 5.0 / 16.0;
    c[4] *= 5.0 / 32.0;
    c[8] *= 5.0 / 32.0;
}

void alp_sh_multiply_cosine(const alp_sh9 *radiance, const float normal[3], alp_sh9 *product)
{
    const vec3 n = vec3_load(normal);
    vec3 t, b;
    vec3_frame(n, &t, &b);
    // The rows of the turn that brings n to z are t, b and n; column-major, they lie across.
    const double to_z[9] = {(double)t.x, (double)b.x, (double)n.x, (double)t.y, (double)b.y,
                            (double)n.y, (double)t.z, (double)b.z, (double)n.z};
    const double back[9] = {(double)t.x, (double)t.y, (double)t.z, (double)b.x, (double)b.y,
                            (double)b.z, (double)n.x, (double)n.y, (double)n.z};
    alpi_sh_rotation there, home;
    alpi_sh_rotation_set(&there, 2, to_z);
    alpi_sh_rotation_set(&home, 2, back);
    for (int k = 0; k < 3; k++) {
        double c[ALPI_SH9_COUNT], turned[ALPI_SH9_COUNT];
        for (int i = 0; i < ALPI_SH9_COUNT; i++) {
            c[i] = (double)radiance->c[i][k];
        }
        alpi_sh_rotation_apply(&there, c, turned);
        multiply_lobe_of_z(turned);
        alpi_sh_rotation_apply(&home, turned, c);
        for (int i = 0; i < ALPI_SH9_COUNT; i++) {
            product->c[i][k] = (float)c[i];
        }
    }
}
