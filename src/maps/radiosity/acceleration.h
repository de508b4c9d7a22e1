// SPDX-License-Identifier: MIT
// Fewer passes of radiosity where panes make each trace its rays anew. A pass takes light x to
// G(x). The next light is the mix of the last three G(x) whose mixed residuals G(x) − x are the
// smallest. Based on: D. G. Anderson. Iterative Procedures for Nonlinear Integral Equations. J. ACM
// 12(4), 1965; H. F. Walker, P. Ni. Anderson Acceleration for Fixed-Point Iterations. SIAM J.
// Numer. Anal. 49(4), 2011.
#ifndef ALPI_MAPS_ACCELERATION_H
#define ALPI_MAPS_ACCELERATION_H

#include "maps/radiosity/radiosity.h"

enum { ALPI_ACCELERATION_DEPTH = 2 };

/// Results and residuals of the passes before, the last one first.
typedef struct alpi_acceleration {
    float (*results[ALPI_ACCELERATION_DEPTH])[3];   // [sides × blocks] G(x)
    float (*residuals[ALPI_ACCELERATION_DEPTH])[3]; // [sides × blocks] G(x) − x
    uint32_t count;                                 // of those that are known
} alpi_acceleration;

/// @return ALP_OK; OUT_OF_MEMORY: what was made is released by alpi_acceleration_destroy too
alp_result alpi_acceleration_create(alp_context *context, size_t blocks, alpi_acceleration *a);
void alpi_acceleration_destroy(alp_context *context, alpi_acceleration *a);

/// Replaces the light that the last pass gathered, radiosity->bounced, by that which the next pass
/// shall show. It gathered from radiosity->before. No light becomes negative.
/// @return ALP_OK; CANCELLED
alp_result alpi_acceleration_mix(alpi_acceleration *a, alpi_radiosity *radiosity,
                                 const alpi_task_progress *progress);

#endif
