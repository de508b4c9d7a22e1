// SPDX-License-Identifier: MIT
// Directional lights with a size: disks of even radiance at infinity.
#ifndef ALPI_SCENE_LIGHTING_SUNS_H
#define ALPI_SCENE_LIGHTING_SUNS_H

#include "scene/double3.h"
#include "scene/scene.h"

/// Smaller disks, of full angle, are points: float directions could not tell what is inside.
#define ALPI_SUN_LEAST_SIZE 2e-4f

typedef struct alpi_sun {
    uint32_t light;     // index in the lighting's lights
    double3 toward;     // unit
    double half;        // radians
    double rise;        // 1 − cos(half) = 2 sin²(half/2)
    double sine;        // of half
    double illuminance; // E⊥, mean of the channels
    vec3 radiance;      // E⊥ / (π sin²(half))
} alpi_sun;

/// @param light directional, with a size of ALPI_SUN_LEAST_SIZE or more
alpi_sun alpi_sun_from(const alpi_light *light, uint32_t index);

/// At least the share of E⊥ that a surface gets; 0 where all of the disk is below its horizon.
double alpi_sun_importance(const alpi_sun *sun, vec3 normal);

/// Draws a direction in the disk, uniform in solid angle. @param u [0,1)²
vec3 alpi_sun_sample(const alpi_sun *sun, vec2 u);
/// Whether a direction is within the disk.
bool alpi_sun_holds(const alpi_sun *sun, vec3 direction);
/// Per steradian, in the disk.
double alpi_sun_density(const alpi_sun *sun);

#endif
