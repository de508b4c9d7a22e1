// SPDX-License-Identifier: MIT
// A few points that are lit and shaded as texels will be: what an estimate knows of a scene.
#ifndef ALPI_BAKE_PILOT_H
#define ALPI_BAKE_PILOT_H

#include "bake/job.h"

enum { ALPI_PILOT_POINTS = 128, ALPI_PILOT_DIRECT_SAMPLES = 16, ALPI_PILOT_RAYS = 64 };

/// What points tell that lie evenly on the surfaces of a bake. Errors are standard errors of a
/// point, root mean square; seconds are wall time with all workers at work.
typedef struct alpi_pilot {
    uint32_t count; // of points of light
    // Light.
    double variances[ALPI_PILOT_POINTS]; // of direct light by DIRECT_SAMPLES, mean of the channels
    double mean;                         // of direct light, W·m⁻²
    double rays;                         // of a direct sample
    double direct_seconds;               // of a direct sample
    double once_bounced;                 // mean of light that was reflected once at most
    double path_seconds;                 // of a path of two rays
    double ray_seconds;                  // of a ray that gathers bounced light
    double bounced_error; // of what such rays find, by RAYS paths of a point, W·m⁻²
    // Occlusion.
    double occlusion_seconds; // of a ray, in packets as a bake sends them
    double occlusion_error;   // of a texel by RAYS rays, over the mean
} alpi_pilot;

/// Shades points. What is not asked for stays 0.
/// @param area  of the surfaces that are chosen, m²
/// @param texel edge of a texel, metres
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED (the tracer is made here, where there is none yet);
///         UNSUPPORTED, the tracer does not start
alp_result alpi_pilot_run(const alpi_bake_job *job, double area, double texel, alpi_pilot *pilot);

/// Area of a triangle of a scene, m².
double alpi_pilot_area(const alp_scene *scene, uint32_t triangle);
/// Whether a bake's maps have texels of their own for a triangle.
bool alpi_pilot_is_chosen(const alpi_bake_job *job, uint32_t triangle);

#endif
