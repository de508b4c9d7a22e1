// SPDX-License-Identifier: MIT
// The error of an ambience volume about the camera.
#ifndef COMMAND_AMBIENCE_ERROR_H
#define COMMAND_AMBIENCE_ERROR_H

#include "ambience/flight_run.h"

typedef struct ambience_error {
    bool direct;      // light straight from lamps and suns is in E
    uint32_t samples; // paths of the reference at a point
    uint64_t seed;
} ambience_error;

/// Measures 100 Σ|E − Eref| / ΣEref over the channels of 64 free points within 20 m of the camera,
/// with random normals.
/// @param second  the key of the points
/// @param percent out; NAN if there are no free points, or none of them has light
/// @return as alp_reference_irradiance
alp_result ambience_error_measure(const ambience_error *e, flight_run *run,
                                  const flight_frame *frame, uint32_t second, double *percent);

#endif
