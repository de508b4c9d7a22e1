// SPDX-License-Identifier: MIT
// The noise of a map, and its stated error.
#ifndef ALPI_BAKE_OCCLUSION_ERROR_H
#define ALPI_BAKE_OCCLUSION_ERROR_H

#include "bake/occlusion/occlusion_state.h"

/// Noise of a traced texel by the spread of its quarters, root mean square over the map. It is
/// about 1.8 times the true standard deviation.
/// @param traced out: number of traced texels
alp_result alpi_occlusion_measure_noise(alpi_occlusion_state *state, float *noise,
                                        uint32_t *traced);
/// Traces the held-out rays of this round, and fills task->errors and the errors of the report,
/// even where the rays were cut off.
alp_result alpi_occlusion_measure_error(alpi_occlusion_state *state);

#endif
