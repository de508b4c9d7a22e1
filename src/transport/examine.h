// SPDX-License-Identifier: MIT
// What will surprise who lights a scene, told before the long work.
#ifndef ALPI_TRANSPORT_EXAMINE_H
#define ALPI_TRANSPORT_EXAMINE_H

#include "scene/lights/lighting.h"
#include "trace/trace.h"

/// Warns as alp_scene_examine tells.
/// @param filter what the rays of the bake pass through
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_examine_light(const alpi_tracer *tracer, alpi_trace_filter filter,
                              const alp_scene *scene, const alpi_lighting *lighting,
                              alp_progress_fn *progress, void *progress_user);

/// Whether of rays from a place those that meet anything (8 at least) meet, but for 5 %, the backs
/// of single-sided surfaces first: it lies inside something, or behind a wall.
/// @param directions [count], unit   @param count a multiple of ALPI_PACKET
bool alpi_examine_is_inside(const alpi_tracer *tracer, alpi_trace_filter filter,
                            const alp_scene *scene, vec3 place, const vec3 *directions,
                            uint32_t count);

#endif
