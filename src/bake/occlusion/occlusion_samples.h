// SPDX-License-Identifier: MIT
// Rays of marked texels.
#ifndef ALPI_BAKE_OCCLUSION_SAMPLES_H
#define ALPI_BAKE_OCCLUSION_SAMPLES_H

#include "bake/occlusion/occlusion_state.h"

/// Whether a texel is to be traced next.
typedef bool alpi_occlusion_rule(const alpi_occlusion_task *task, uint32_t texel);
/// Sets the marks of all texels by a rule.
alp_result alpi_occlusion_mark(alpi_occlusion_state *state, alpi_occlusion_rule *rule);
/// Traces the marked texels and clears the marks. @param count out: how many there were
alp_result alpi_occlusion_trace_marked(alpi_occlusion_state *state, uint32_t *count);
/// Traces the samples [before, samples) of texels that were traced in the round before.
alp_result alpi_occlusion_trace_more(alpi_occlusion_state *state);
/// Prepares the sums of listed receivers for more samples. If these are a multiple of those before,
/// the old quarters merge into the first. Otherwise each quarter gets its share of the new samples.
void alpi_occlusion_extend_quarters(alpi_occlusion_sums *sums, const uint32_t *list, uint32_t count,
                                    uint32_t before, uint32_t samples);

#endif
