// SPDX-License-Identifier: MIT
// What will surprise who lights a scene, told before the long work.
#ifndef ALPI_TRANSPORT_EXAMINE_H
#define ALPI_TRANSPORT_EXAMINE_H

#include "scene/lighting.h"
#include "trace/trace.h"

/// Warns as alp_scene_examine tells.
/// @param filter what the rays of the bake pass through
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_examine_light(const alpi_tracer *tracer, alpi_trace_filter filter,
                              const alp_scene *scene, const alpi_lighting *lighting,
                              alp_progress_fn *progress, void *progress_user);

#endif
