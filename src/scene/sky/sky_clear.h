// SPDX-License-Identifier: MIT
// Luminance and colour of a clear or hazy sky, in closed form.
#ifndef ALPI_SCENE_SKY_CLEAR_H
#define ALPI_SCENE_SKY_CLEAR_H

#include "base/context.h"
#include "base/vec.h"

struct alpi_clear_sky;
/// Radiances from `count` unit directions, none below the horizon: linear Rec.709 whose luminance
/// is the sky's in cd/m². What Rec.709 cannot show is clamped at 0. Each channel is right to 1e-6
/// of the sum of the three, at every turbidity, for the cosine to the sun that floats tell: it is
/// right to 2e-7, which beside the sun is an angle of 6e-4.
typedef void alpi_clear_sky_fn(const struct alpi_clear_sky *sky, const vec3 *directions,
                               uint32_t count, vec3 *radiances);
/// One after the other, where there are few; for any machine, and for x86-64-v3: the same bits.
alpi_clear_sky_fn alpi_clear_sky_radiances_one_by_one, alpi_clear_sky_radiances_baseline,
    alpi_clear_sky_radiances_v3;

typedef struct alpi_clear_sky {
    alpi_clear_sky_fn *radiances; // for any machine, until its owner knows better
    vec3 sun;                     // unit, not below the horizon
    double perez[3][5];           // A…E for Y, x, y
    double scale[3];              // Y [cd/m²], x and y at the zenith over the distribution there
} alpi_clear_sky;

/// @param sun towards the sun, unit; one below the horizon is lifted to it, and the sky fades: by
///            ten for every 3° (daylight falls from 400 lux at 0° to 3.4 at −6°, US Naval
///            Observatory), to nothing at −18°, the end of astronomical twilight
/// @param turbidity [1.7, 10]
/// @return the factor of that fading, 0 to 1
double alpi_clear_sky_init(alpi_clear_sky *sky, vec3 sun, double turbidity);

#endif
