// SPDX-License-Identifier: MIT
// Receivers → ambient occlusion. Knows neither texel nor probe.
#ifndef ALPI_TRANSPORT_OCCLUSION_H
#define ALPI_TRANSPORT_OCCLUSION_H

#include "scene/receivers.h"
#include "trace/trace.h"

#include <alpenglow/occlusion.h>

/// Options with everything resolved that is the same for all receivers.
typedef struct alpi_occlusion_setup {
    const alpi_tracer *tracer;
    alp_occlusion_options options;
    float distance;  // metres, INFINITY = no limit
    float cone_sin2; // sin² of the cone's half-angle
    float cone_cos;  // cos of it
    alpi_trace_filter filter;
} alpi_occlusion_setup;

/// @return ALP_OK; INVALID_ARGUMENT: a value out of its range, named
alp_result alpi_occlusion_check(const alp_scene *scene, const alp_occlusion_options *options);

/// `options` must have passed the check.
alpi_occlusion_setup alpi_occlusion_prepare(const alp_scene *scene, const alpi_tracer *tracer,
                                            const alp_occlusion_options *options);

/// One receiver, as the arrays of alpi_receivers hold it.
typedef struct alpi_receiver {
    uint64_t key; // its random numbers
    vec3 position, geometric_normal, shading_normal;
    float offset; // metres along the geometric normal at which its rays start
} alpi_receiver;

/// Sum of w over samples [first, first + count) of one receiver: accessibility = 1 − sum / samples.
double alpi_occlusion_sum(const alpi_occlusion_setup *setup, const alpi_receiver *receiver,
                          uint32_t first, uint32_t count);

/// Accessibility of the receivers in `list` (NULL = all, then list_count is receivers->count), on
/// all workers; progress stage "occlusion", in rays. Neighbours in the list should be neighbours in
/// space: they are traced together.
/// @param accessibility [receivers->count] out; only those of the list are written
alp_result alpi_occlusion_gather(alp_context *context, const alpi_occlusion_setup *setup,
                                 const alpi_receivers *receivers, const uint32_t *list,
                                 uint32_t list_count, float *accessibility);

#endif
