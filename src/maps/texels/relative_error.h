// SPDX-License-Identifier: MIT
// The error of a map in two numbers, from the standard errors of its texels.
#ifndef ALPI_MAPS_RELATIVE_ERROR_H
#define ALPI_MAPS_RELATIVE_ERROR_H

#include "base/tasks.h"
#include "maps/texels/lattice.h"

/// The limit of the 99th percentile of the texels' errors, over the wanted error.
#define ALPI_P99_LIMIT 4.0

/// Error of the texels that have a value, over the mean of their values; 0 without any. Each texel
/// counts alike.
typedef struct alpi_relative_error {
    double rms; // root mean square of the standard errors
    double p99; // their 99th percentile
} alpi_relative_error;
/// @param errors   [texels] standard errors; 0 without a value
/// @param progress NULL, or a callback that may cancel
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_find_relative_error(const alpi_lattice *lattice, const float *errors,
                                    const uint32_t *order, uint32_t order_count,
                                    const alpi_task_progress *progress,
                                    alpi_relative_error *relative);

/// The smallest value that `share` of the texels in `order` do not exceed.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED by the watch of the context
alp_result alpi_percentile(alp_context *context, const float *values, const uint32_t *order,
                           uint32_t order_count, double share, double *value);

#endif
