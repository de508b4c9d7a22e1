// SPDX-License-Identifier: MIT
// Rays of the next round.
#ifndef ALPI_BAKE_OCCLUSION_PLAN_H
#define ALPI_BAKE_OCCLUSION_PLAN_H

#include "bake/occlusion/occlusion_rounds.h"

/// Samples of a traced texel in the first round.
uint32_t alpi_occlusion_first_samples(const alpi_occlusion_task *task);
/// Samples of a traced texel after the next round, those of the rounds before included.
/// @param report the map after the last round
/// @return 0: the error is reached, or all samples of the setup are spent
uint32_t alpi_occlusion_next_samples(const alpi_occlusion_task *task,
                                     const alpi_occlusion_report *report);

#endif
