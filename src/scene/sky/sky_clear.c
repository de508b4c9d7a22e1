// SPDX-License-Identifier: MIT
// The clear sky of A. J. Preetham, Peter Shirley, Brian Smits: A Practical Analytic Model for
// Daylight. SIGGRAPH 1999, appendix A.2: the five-parameter distribution of Perez et al. 1993 with
// coefficients linear in the turbidity, for luminance and both chromaticities.
#include "scene/sky/sky_clear.h"

/// A…E of Y, x, y as slope · turbidity + offset.
static const double DISTRIBUTION[3][5][2] = {
    {{0.1787, -1.4630}, {-0.3554, 0.4275}, {-0.0227, 5.3251}, {0.1206, -2.5771}, {-0.0670, 0.3703}},
    {{-0.0193, -0.2592},
     {-0.0665, 0.0008},
     {-0.0004, 0.2125},
     {-0.0641, -0.8989},
     {-0.0033, 0.0452}},
    {{-0.0167, -0.2608},
     {-0.0950, 0.0092},
     {-0.0079, 0.2102},
     {-0.0441, -1.6537},
     {-0.0109, 0.0529}},
};

/// x and y at the zenith: rows T², T, 1; columns θs³, θs², θs, 1.
static const double ZENITH[2][3][4] = {
    {{0.00166, -0.00375, 0.00209, 0.0},
     {-0.02903, 0.06377, -0.03202, 0.00394},
     {0.11693, -0.21196, 0.06052, 0.25886}},
    {{0.00275, -0.00610, 0.00317, 0.0},
     {-0.04214, 0.08970, -0.04153, 0.00516},
     {0.15346, -0.26756, 0.06670, 0.26688}},
};

/// @param cos_gamma, gamma angle to the sun
static double distribution(const double p[5], double cosine, double cos_gamma, double gamma)
{
    return (1.0 + p[0] * exp(p[1] / cosine)) *
           (1.0 + p[2] * exp(p[3] * gamma) + p[4] * cos_gamma * cos_gamma);
}

static double zenith_chromaticity(const double rows[3][4], double turbidity, double theta)
{
    double value = 0.0;
    for (int i = 0; i < 3; i++) {
        const double *r = rows[i];
        value = value * turbidity + (((r[0] * theta + r[1]) * theta + r[2]) * theta + r[3]);
    }
    return value;
}

/// How much of the sky's light is left, and the sun lifted to the horizon.
static double twilight(vec3 *sun)
{
    if (sun->y >= 0.0f) {
        return 1.0;
    }
    double degrees = -asin(fmin(-(double)sun->y, 1.0)) * 180.0 / ALPI_PI;
    *sun = vec3_normalize_or((vec3){sun->x, 0.0f, sun->z}, (vec3){0.0f, 0.0f, -1.0f});
    return degrees > -18.0 ? pow(10.0, degrees / 3.0) : 0.0;
}

double alpi_clear_sky_init(alpi_clear_sky *sky, vec3 sun, double turbidity)
{
    double fading = twilight(&sun);
    double theta = acos(fmin((double)sun.y, 1.0)), t = turbidity;
    double chi = (4.0 / 9.0 - t / 120.0) * (ALPI_PI - 2.0 * theta);
    // The paper's formula gives kilocandelas per square metre.
    const double zenith[3] = {1000.0 * ((4.0453 * t - 4.9710) * tan(chi) - 0.2155 * t + 2.4192),
                              zenith_chromaticity(ZENITH[0], t, theta),
                              zenith_chromaticity(ZENITH[1], t, theta)};
    sky->radiances = alpi_clear_sky_radiances_baseline;
    sky->sun = sun;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 5; k++) {
            sky->perez[i][k] = DISTRIBUTION[i][k][0] * t + DISTRIBUTION[i][k][1];
        }
        sky->scale[i] = zenith[i] / distribution(sky->perez[i], 1.0, cos(theta), theta);
    }
    return fading;
}
