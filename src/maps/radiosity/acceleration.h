// SPDX-License-Identifier: MIT
// Acceleration of passes that trace their rays again because of panes. A pass maps light x to G(x).
// The next light mixes the last three G(x) so that the mixed residual G(x) − x is smallest.
// Based on: D. G. Anderson. Iterative Procedures for Nonlinear Integral Equations. J. ACM
// 12(4), 1965; H. F. Walker, P. Ni. Anderson Acceleration for Fixed-Point Iterations. SIAM J.
// Numer. Anal. 49(4), 2011.
#ifndef ALPI_MAPS_ACCELERATION_H
#define ALPI_MAPS_ACCELERATION_H

#include "maps/radiosity/radiosity.h"

enum { ALPI_ACCELERATION_DEPTH = 2 };

/// Results and residuals of earlier passes, the last one first.
typedef struct alpi_acceleration {
    float (*results[ALPI_ACCELERATION_DEPTH])[3];   // [sides × patches] G(x)
    float (*residuals[ALPI_ACCELERATION_DEPTH])[3]; // [sides × patches] G(x) − x
    uint32_t count;                                 // of the known ones
} alpi_acceleration;

/// @return ALP_OK; OUT_OF_MEMORY: alpi_acceleration_destroy frees the rest
alp_result alpi_acceleration_create(alp_context *context, size_t patches, alpi_acceleration *a);
void alpi_acceleration_destroy(alp_context *context, alpi_acceleration *a);

/// Replaces radiosity->bounced, which the last pass gathered from radiosity->before, by the light
/// that the next pass starts from. No light becomes negative.
/// @return ALP_OK; CANCELLED
alp_result alpi_acceleration_mix(alpi_acceleration *a, alpi_radiosity *radiosity,
                                 const alpi_task_progress *progress);

#endif
