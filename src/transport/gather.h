// SPDX-License-Identifier: MIT
// What all gatherers share: what their rays bring back, and how they are asked.
#ifndef ALPI_TRANSPORT_GATHER_H
#define ALPI_TRANSPORT_GATHER_H

#include "scene/lighting.h"
#include "scene/receivers.h"
#include "trace/trace.h"
#include "transport/surface_light.h"

/// What a gatherer looks at; all borrowed. Emissive surfaces and the sky count where a ray happens
/// to meet them, or else are direct light's, which knows better ways to them (alpi_direct). Lamps
/// and suns always are: no ray meets a point, and a sun's disk is smaller than what is between two
/// rays, so that it would count in one place for many times what it gives and in most for nothing.
/// (A sun in the picture of a sky is the sky's.)
typedef struct alpi_gather_scene {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    const alpi_lighting *lighting; // NULL: no sky
    alpi_trace_filter filter;      // panes are seen to here, whatever it says
    alpi_surface_light light;
    bool emitters, sky; // that they count
} alpi_gather_scene;

/// Radiance that comes back along rays, through panes on their way.
/// @param rays     unit directions; destroyed
/// @param active   bit i: lane i
/// @param coherent the rays of the packet leave in about one direction
/// @param radiance out; 0 of lanes that are not active
void alpi_gather_look(const alpi_gather_scene *from, alpi_rays *rays, uint32_t active,
                      bool coherent, vec3 radiance[ALPI_PACKET]);

/// Gathers the irradiance E [W·m⁻²] of one receiver. Called by many threads. What is random in it
/// is keyed by the receiver.
/// @return ALP_OK; CANCELLED
typedef alp_result alpi_gather_fn(const void *user, const alpi_receivers *receivers,
                                  uint32_t receiver, float irradiance[3]);

/// A way of gathering: hemicube, or rays.
typedef struct alpi_gatherer {
    alpi_gather_fn *gather;
    const void *user; // what it reads
} alpi_gatherer;

#endif
