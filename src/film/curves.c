// SPDX-License-Identifier: MIT
// Tone curves: exposed light of any strength to values that a screen has.
// Based on: E. Reinhard, M. Stark, P. Shirley, J. Ferwerda. Photographic tone reproduction for
// digital images. SIGGRAPH 2002, equation 4; J. Hable. Filmic tonemapping operators. 2010.
#include "film/curves.h"

#include <alpenglow/shared_constants.h>

#include <math.h>

double alpi_film_default_white(alp_tone tone)
{
    return tone == ALP_TONE_FILMIC ? ALP_FILMIC_WHITE : ALP_REINHARD_WHITE;
}

/// (x(Ax + CB) + DE) / (x(Ax + B) + DF) − E/F with Hable's constants, brought to one fraction:
/// as it stands it loses all its digits near 0.
static double filmic(double light)
{
    const double a = ALP_FILMIC_A, b = ALP_FILMIC_B, c = ALP_FILMIC_C;
    const double d = ALP_FILMIC_D, e = ALP_FILMIC_E, f = ALP_FILMIC_F;
    const double x = ALP_FILMIC_GAIN * fmin(light, ALP_TONE_BRIGHTEST);
    return x * ((f - e) * a * x + b * (c * f - e)) / (f * (x * (a * x + b) + d * f));
}

double alpi_film_curve(alp_tone tone, double white, double light)
{
    double l = light > 0.0 ? fmin(light, ALP_TONE_BRIGHTEST) : 0.0;
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
