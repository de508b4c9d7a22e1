// SPDX-License-Identifier: MIT
// Directional lights with a size. All in double: half the sun's disk is 1e-5 of a cosine.
#include "scene/lights/lighting_suns.h"

#include "base/warp.h"

alpi_sun alpi_sun_from(const alpi_light *light, uint32_t index)
{
    alpi_sun sun = {.light = index, .half = 0.5 * (double)light->size};
    sun.toward = double3_unit(double3_scale(double3_from(light->direction), -1.0));
    double half_sine = sin(0.5 * sun.half), sine = sin(sun.half);
    sun.rise = 2.0 * half_sine * half_sine;
    sun.sine = sine;
    double per_lux = 1.0 / (ALPI_PI * sine * sine), lux = (double)light->intensity;
    double x = lux * (double)light->color.x, y = lux * (double)light->color.y,
           z = lux * (double)light->color.z;
    sun.illuminance = (x + y + z) / 3.0;
    sun.radiance = (vec3){(float)(x * per_lux), (float)(y * per_lux), (float)(z * per_lux)};
    return sun;
}

double alpi_sun_importance(const alpi_sun *sun, vec3 normal)
{
    double cosine = double3_dot(sun->toward, double3_from(normal));
    // cos(angle − half), where the angle is more
    double sine = sqrt(fmax(1.0 - cosine * cosine, 0.0)), near = 1.0 - sun->rise;
    double nearest = cosine >= near ? 1.0 : cosine * near + sine * sun->sine;
    return sun->illuminance * fmax(nearest, 0.0);
}

vec3 alpi_sun_sample(const alpi_sun *sun, vec2 u)
{
    vec3 t, b;
    vec2 d = alpi_warp_disk(u);
    double x = (double)d.x, y = (double)d.y, r2 = x * x + y * y;
    double aside = sqrt(sun->rise * (2.0 - sun->rise * r2)); // as alpi_warp_uniform_cone
    vec3_frame(double3_to_vec3(sun->toward), &t, &b);
    double3 direction = double3_scale(sun->toward, 1.0 - sun->rise * r2);
    direction = double3_add(direction, double3_scale(double3_from(t), x * aside));
    direction = double3_add(direction, double3_scale(double3_from(b), y * aside));
    return double3_to_vec3(double3_unit(direction));
}

bool alpi_sun_holds(const alpi_sun *sun, vec3 direction)
{
    if (double3_dot(double3_from(direction), sun->toward) < 1.0 - sun->rise - 1e-4) {
        return false; // by far, as almost always
    }
    double3 chord = double3_sub(double3_unit(double3_from(direction)), sun->toward);
    return double3_dot(chord, chord) <= 2.0 * sun->rise; // |chord| = 2 sin(angle/2)
}

double alpi_sun_density(const alpi_sun *sun)
{
    return 1.0 / (2.0 * ALPI_PI * sun->rise);
}
