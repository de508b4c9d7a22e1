// SPDX-License-Identifier: MIT
// Light straight from punctual lights and suns at points in space, as spherical harmonics.
#ifndef ALPI_TRANSPORT_SPHERE_LAMPS_H
#define ALPI_TRANSPORT_SPHERE_LAMPS_H

#include "transport/sphere/sphere_rays.h"

/// A light without extent of illuminance E⊥ from ω gives c = E⊥ Y(ω). A sun's disk is sampled.
typedef struct alpi_sphere_lamps {
    const alpi_sphere_rays *rays;  // scene, tracer, filter and seed are read
    const alpi_lighting *lighting; // whose lights
    uint32_t light;                // one of them, or ALPI_NONE: all
    const float (*points)[3];      // metres
    const uint32_t *list;          // [count] points; NULL: all
    uint32_t count;
    alpi_sphere_light *values; // [points] in, out: their light is added to
} alpi_sphere_lamps;

/// @return ALP_OK; CANCELLED
alp_result alpi_sphere_lamps_add(const alpi_sphere_lamps *job, const alpi_task_progress *progress);

/// The same of one point, which need not be one of the job's. @param number key of its random
/// numbers
void alpi_sphere_lamps_at(const alpi_sphere_lamps *job, vec3 point, uint32_t number, alpi_sh9 *sum);

#endif
