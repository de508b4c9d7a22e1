// SPDX-License-Identifier: MIT
#include "ambience/day.h"

#include <math.h>

static const double LOWEST =
    0.1 * M_PI / 180.0; // radians: elevation that the sun never sinks below
static const double NIGHT_SUN = 1e-4, NIGHT_SKY = 1e-2;

/// Share of the sun's light at sine `s` of its elevation, of that at `noon`, by the path in air.
static double through_air(double s, double noon)
{
    const double depth = 0.2; // of air above
    return s > 0.02 ? fmax(NIGHT_SUN, exp(-depth * (1.0 / s - 1.0 / noon))) : NIGHT_SUN;
}

alp_lighting_options day_lighting(const alp_lighting_options *noon, double seconds, double time)
{
    alp_lighting_options now = *noon;
    if (!(seconds > 0.0)) {
        return now;
    }
    const double azimuth = (double)noon->sun.azimuth, elevation = (double)noon->sun.elevation;
    const double hour = 2.0 * M_PI * fmod(time / seconds, 1.0), c = cos(hour), s = sin(hour);
    const double x = c * sin(azimuth) * cos(elevation) - s * cos(azimuth);
    const double y = c * sin(elevation);
    const double z = c * cos(azimuth) * cos(elevation) + s * sin(azimuth);
    const double height = asin(fmin(1.0, fmax(-1.0, y)));
    now.sun.azimuth = hypot(x, z) > 1e-9 ? (float)atan2(x, z) : noon->sun.azimuth;
    now.sun.elevation = (float)fmax(LOWEST, height);
    now.sun.illuminance *= (float)through_air(y, sin(elevation));
    if (now.sky.kind == ALP_SKY_CLEAR && height < LOWEST) { // tenfold every 3 degrees
        const double degrees = (LOWEST - height) * (180.0 / M_PI);
        now.sky.strength *= (float)fmax(NIGHT_SKY, pow(10.0, -degrees / 3.0));
    }
    return now;
}
