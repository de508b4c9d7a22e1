// SPDX-License-Identifier: MIT
// Light beside the file's: defaults and checks.
#include "scene/lighting_options.h"

alp_lighting_options alp_lighting_options_default(void)
{
    return (alp_lighting_options){
        .struct_size = sizeof(alp_lighting_options),
        .sky = {.up = {1.0f, 1.0f, 1.0f}, .strength = 1.0f, .turbidity = 3.0f},
        .sun = {.color = {1.0f, 1.0f, 1.0f}, .size = 0.0093f}};
}

/// NaN fails.
static bool is_within(float value, double low, double high)
{
    return (double)value >= low && (double)value <= high;
}

alp_result alpi_lighting_options_check(alp_context *context, const alp_lighting_options *o)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    const double quarter = ALPI_PI / 2.0 * (1.0 + 1e-6); // a float of it may be larger
    if (o->struct_size != sizeof *o) {
        return alpi_fail(context, code, "lighting options are not from _default()");
    }
    if (!isfinite(o->sun.azimuth)) {
        return alpi_fail(context, code, "sun: azimuth %g rad, need a number",
                         (double)o->sun.azimuth);
    }
    if (!is_within(o->sun.elevation, -quarter, quarter)) {
        return alpi_fail(context, code, "sun: elevation %g rad, need -pi/2 to pi/2",
                         (double)o->sun.elevation);
    }
    if (!is_within(o->sun.illuminance, 0.0, 1e20)) {
        return alpi_fail(context, code, "sun: illuminance %g lux, need 0 to 1e20",
                         (double)o->sun.illuminance);
    }
    for (int k = 0; k < 3; k++) {
        if (!is_within(o->sun.color[k], 0.0, 1e10)) {
            return alpi_fail(context, code, "sun: colour channel %d is %g, need 0 to 1e10", k,
                             (double)o->sun.color[k]);
        }
    }
    if (!is_within(o->sun.size, 0.0, quarter)) {
        return alpi_fail(context, code, "sun: size %g rad, need 0 to pi/2", (double)o->sun.size);
    }
    if (!is_within(o->file_sun_size, 0.0, quarter)) {
        return alpi_fail(context, code, "size of the file's suns: %g rad, need 0 to pi/2",
                         (double)o->file_sun_size);
    }
    return ALP_OK;
}

vec3 alpi_sun_direction(const alp_sun_options *sun)
{
    double azimuth = (double)sun->azimuth, elevation = (double)sun->elevation;
    return (vec3){(float)(sin(azimuth) * cos(elevation)), (float)sin(elevation),
                  (float)(cos(azimuth) * cos(elevation))};
}
