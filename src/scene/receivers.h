// SPDX-License-Identifier: MIT
// Receivers: where light is asked for, whoever made them: texels, vertices, points, probes.
#ifndef ALPI_SCENE_RECEIVERS_H
#define ALPI_SCENE_RECEIVERS_H

#include "base/context.h"
#include "base/vec.h"

/// One point of a receiver.
typedef struct alpi_receiver_point {
    vec3 position;         // metres: where rays start, before the offset
    vec3 geometric_normal; // unit, of the side that is asked about: direction of the offset
    vec3 shading_normal;   // unit: the hemisphere's axis
    float offset;          // metres along the geometric normal at which rays start: see below
} alpi_receiver_point;

/// Maps points of the unit square, [count][2] in [0, 1)², to points of a receiver. Area-preserving:
/// uniform in, uniform over the receiver's area out. A receiver without extent gives the same point
/// `count` times. Called by many threads at once.
typedef void alpi_place_fn(const void *user, uint32_t receiver, uint32_t count,
                           const float (*square)[2], alpi_receiver_point *points);

/// Things that receive light. What is asked of each is its mean over its points. The index of a
/// receiver is its key for random numbers.
typedef struct alpi_receivers {
    uint32_t count;
    bool extended; // false: one point each, whatever the square says
    alpi_place_fn *place;
    const void *user; // what `place` reads
} alpi_receivers;

/// How far above its surface a ray must start, metres: two float steps of the largest coordinate or
/// edge that takes part. A position is right to half a step of its coordinates; the distance a
/// tracer computes, to about one step of the distance between the position and the triangle's
/// corners (a point near the origin of a floor 1 km wide hits that floor without the second part).
/// @param corners of the triangle the receiver lies on, or NULL when it lies on none
float alpi_receiver_offset(vec3 position, const vec3 *corners);

/// Points as plain arrays.
typedef struct alpi_point_array {
    uint32_t count;
    float (*positions)[3];         // [count] metres, on the surface
    float (*geometric_normals)[3]; // [count] unit, of the triangle: for offset and validity
    float (*shading_normals)[3];   // [count] unit: the hemisphere's axis
    float *offsets;                // [count] metres along the geometric normal at which rays start
} alpi_point_array;

/// Allocates the arrays, zeroed. On failure nothing is left allocated.
alp_result alpi_point_array_create(alp_context *context, uint32_t count, alpi_point_array *points);
void alpi_point_array_destroy(alp_context *context, alpi_point_array *points);
/// Each point as a receiver without extent. The array must outlive the receivers.
alpi_receivers alpi_point_array_receivers(const alpi_point_array *points);

#endif
