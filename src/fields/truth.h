// SPDX-License-Identifier: MIT
// The light that fields hold, by path tracing, and free points to measure it at.
#ifndef ALPI_FIELDS_TRUTH_H
#define ALPI_FIELDS_TRUTH_H

#include "trace/trace.h"
#include "transport/paths/reference.h"

#include <alpenglow/field.h>

/// Largest share of the sphere that black backs of surfaces may fill at a free point. A point that
/// sees more of them lies in a solid or behind a wall.
#define ALPI_FREE_BACKS 0.25f

/// E at points, with variances. The options are checked by the caller.
/// @param values [count] out
/// @return ALP_OK; UNSUPPORTED (the ray tracer fails); OUT_OF_MEMORY; CANCELLED
alp_result alpi_truth_at_points(const alp_scene *scene, const alp_reference_options *options,
                                uint32_t count, const float (*positions)[3],
                                const float (*normals)[3], const char *stage,
                                alpi_reference_value *values);

#endif
