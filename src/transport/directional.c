// SPDX-License-Identifier: MIT
#include "transport/directional.h"

#include <math.h>

double alpi_horizon_width(uint32_t rays)
{
    return fmin(fmax(0.25, 2.0 / sqrt((double)rays)), 1.0);
}

/// 1 / cosθ in the band, and its mean over the lowest part: f(c) with ∫ f(c) c dc = ∫ dc.
static double horizon_stretch(const alpi_directional_sums *sums, double cosine)
{
    const double lowest = 0.25 * sums->width;
    return cosine < lowest ? 2.0 / lowest : 1.0 / cosine;
}

void alpi_directional_count(alpi_directional_sums *sums, double weight, double cosine)
{
    sums->horizon_weight += weight * horizon_stretch(sums, cosine);
}

void alpi_directional_add(alpi_directional_sums *sums, const double irradiance[3],
                          const alpi_directional_way *way)
{
    const double cosine = (double)way->cosine;
    const double stretch = way->horizon ? horizon_stretch(sums, cosine) : 1.0 / cosine;
    double(*sh)[3] = way->horizon ? sums->horizon : sums->sh;
    double along[ALPI_SH1_COUNT], basis[ALPI_SH1_COUNT];
    alpi_sh1_basis(way->normal, along);
    alpi_sh1_basis(way->direction, basis);
    for (int k = 0; k < 3; k++) {
        const double light = irradiance[k] * stretch;
        sh[0][k] += basis[0] * light;
        for (int i = 1; i < ALPI_SH1_COUNT; i++) {
            sums->sh[i][k] += along[i] * irradiance[k];
            sh[i][k] += (basis[i] - cosine * along[i]) * light;
        }
    }
    const double luminance = alpi_luminance(irradiance);
    sums->toward[0] += luminance * (double)way->direction.x;
    sums->toward[1] += luminance * (double)way->direction.y;
    sums->toward[2] += luminance * (double)way->direction.z;
}

void alpi_directional_finish(const alpi_directional_sums *sums, double scale,
                             alpi_directional *directional)
{
    const double weight = sums->horizon_weight;
    const double band = weight > 0.0 ? 2.0 * ALPI_PI * sums->width / weight : 0.0;
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < ALPI_SH1_COUNT; i++) {
            directional->sh[i][k] = (float)(scale * sums->sh[i][k] + band * sums->horizon[i][k]);
        }
        directional->toward[k] = (float)(scale * sums->toward[k]);
    }
}

void alpi_directional_add_found(const alpi_directional_found *found, const double light[3],
                                alpi_directional_sums *sums)
{
    const double luminance = alpi_luminance(found->irradiance);
    const double *e = found->irradiance, whole = e[0] + e[1] + e[2];
    const double scale = luminance > 0.0 ? alpi_luminance(light) / luminance : 0.0;
    for (int k = 0; k < 3; k++) {
        const double all = found->irradiance[k];
        for (int i = 0; i < ALPI_SH1_COUNT && whole > 0.0; i++) {
            const double *sh = found->sums.sh[i]; // of a channel that was not found as of all
            sums->sh[i][k] +=
                light[k] * (all > 0.0 ? sh[k] / all : (sh[0] + sh[1] + sh[2]) / whole);
        }
        sums->toward[k] += scale * found->sums.toward[k];
    }
}

void alpi_directional_mix(alpi_directional *had, float a, const alpi_directional *more, float b)
{
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < ALPI_SH1_COUNT; i++) {
            had->sh[i][k] = a * had->sh[i][k] + b * more->sh[i][k];
        }
        had->toward[k] = a * had->toward[k] + b * more->toward[k];
    }
}
