// SPDX-License-Identifier: MIT
// Tone curves: exposed light of any strength to values that a screen has.
// Based on: E. Reinhard, M. Stark, P. Shirley, J. Ferwerda. Photographic tone reproduction for
// digital images. SIGGRAPH 2002, equation 4; J. Hable. Filmic tonemapping operators. 2010.
#include "film/curves.h"

#include <math.h>

/// Above this all curves have long come to their end; its square is still finite.
static const double BRIGHTEST = 1e30;

/// Hable multiplies by 2 before his curve, and shows 11.2 of its input as white.
static const double FILMIC_GAIN = 2.0, FILMIC_WHITE = 11.2;

double alpi_film_default_white(alp_tone tone)
{
    return tone == ALP_TONE_FILMIC ? FILMIC_WHITE / FILMIC_GAIN : 4.0;
}

/// (x(Ax + CB) + DE) / (x(Ax + B) + DF) − E/F with Hable's constants, brought to one fraction:
/// as it stands it loses all its digits near 0.
static double filmic(double light)
{
    const double a = 0.15, b = 0.50, c = 0.10, d = 0.20, e = 0.02, f = 0.30;
    double x = FILMIC_GAIN * fmin(light, BRIGHTEST);
    return x * ((f - e) * a * x + b * (c * f - e)) / (f * (x * (a * x + b) + d * f));
}

double alpi_film_curve(alp_tone tone, double white, double light)
{
    double l = light > 0.0 ? fmin(light, BRIGHTEST) : 0.0;
    switch (tone) {
    case ALP_TONE_FILM:
        return -expm1(-l);
    case ALP_TONE_REINHARD:
        return l * (1.0 + l / (white * white)) / (1.0 + l);
    case ALP_TONE_FILMIC:
        return filmic(l) / filmic(white);
    case ALP_TONE_NONE:
        break;
    }
    return l;
}
