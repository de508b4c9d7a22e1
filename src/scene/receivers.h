// SPDX-License-Identifier: MIT
// Receivers: where light is asked for. Plain arrays, whoever made them: texels, vertices, probes.
#ifndef ALPI_SCENE_RECEIVERS_H
#define ALPI_SCENE_RECEIVERS_H

#include "base/context.h"

/// Points on or above surfaces. Index i is the receiver's key for random numbers.
typedef struct alpi_receivers {
    uint32_t count;
    float (*positions)[3];         // [count] metres, on the surface
    float (*geometric_normals)[3]; // [count] unit, of the triangle: for offset and validity
    float (*shading_normals)[3];   // [count] unit: the hemisphere's axis
} alpi_receivers;

/// Allocates the arrays, zeroed. On failure nothing is left allocated.
alp_result alpi_receivers_create(alp_context *context, uint32_t count, alpi_receivers *receivers);
void alpi_receivers_destroy(alp_context *context, alpi_receivers *receivers);

#endif
