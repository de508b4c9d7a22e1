// SPDX-License-Identifier: MIT
// Luminance and colour of a clear or hazy sky, in closed form.
#ifndef ALPI_SCENE_SKY_CLEAR_H
#define ALPI_SCENE_SKY_CLEAR_H

#include "base/vec.h"

typedef struct alpi_clear_sky {
    vec3 sun;           // unit, not below the horizon
    double perez[3][5]; // A…E for Y, x, y
    double scale[3];    // Y [cd/m²], x and y at the zenith over the distribution there
} alpi_clear_sky;

/// @param sun towards the sun, unit; one below the horizon is lifted to it, and the sky fades: by
///            ten for every 3° (daylight falls from 400 lux at 0° to 3.4 at −6°, US Naval
///            Observatory), to nothing at −18°, the end of astronomical twilight
/// @param turbidity [1.7, 10]
/// @return the factor of that fading, 0 to 1
double alpi_clear_sky_init(alpi_clear_sky *sky, vec3 sun, double turbidity);

/// Radiance from a unit direction above the horizon: linear Rec.709 whose luminance is the sky's in
/// cd/m². What Rec.709 cannot show is clamped at 0.
vec3 alpi_clear_sky_radiance(const alpi_clear_sky *sky, vec3 direction);

#endif
