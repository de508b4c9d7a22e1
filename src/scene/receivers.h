// SPDX-License-Identifier: MIT
// Receivers: where light is asked for. Plain arrays, whoever made them: texels, vertices, probes.
#ifndef ALPI_SCENE_RECEIVERS_H
#define ALPI_SCENE_RECEIVERS_H

#include "base/context.h"
#include "base/vec.h"

/// Points on or above surfaces. Index i is the receiver's key for random numbers.
typedef struct alpi_receivers {
    uint32_t count;
    float (*positions)[3];         // [count] metres, on the surface
    float (*geometric_normals)[3]; // [count] unit, of the triangle: for offset and validity
    float (*shading_normals)[3];   // [count] unit: the hemisphere's axis
    float *offsets; // [count] metres along the geometric normal at which rays start: see below
} alpi_receivers;

/// How far above its surface a ray must start, metres: two float steps of the largest coordinate or
/// edge that takes part. A position is right to half a step of its coordinates; the distance a
/// tracer computes, to about one step of the distance between the position and the triangle's
/// corners (a point near the origin of a floor 1 km wide hits that floor without the second part).
/// @param corners of the triangle the receiver lies on, or NULL when it lies on none
float alpi_receiver_offset(vec3 position, const vec3 *corners);

/// Allocates the arrays, zeroed. On failure nothing is left allocated.
alp_result alpi_receivers_create(alp_context *context, uint32_t count, alpi_receivers *receivers);
void alpi_receivers_destroy(alp_context *context, alpi_receivers *receivers);

#endif
