// SPDX-License-Identifier: MIT
// Samples of direct light, and how many of them each texel gets.
#ifndef ALPI_BAKE_LIGHT_SAMPLES_H
#define ALPI_BAKE_LIGHT_SAMPLES_H

#include "bake/light/light_state.h"

/// Direct light alone, with as many samples at each texel (--bounces 0). Fills light->values.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_sample_all(alpi_light_bake *light);

/// The error of direct light falls with samples^−this, at first. Independent samples have .5;
/// measured: .53 to .64.
#define ALPI_LIGHT_FIRST_POWER 0.6
/// The power that more samples have shown: at least .5, at most .75, that of stratified samples of
/// an edge.
/// @param power     assumed before
/// @param predicted error over the one before, by that power: < 1
/// @param measured  error over the one before
double alpi_light_power(double power, double predicted, double measured);

/// Mean of two estimates by their numbers of samples.
void alpi_light_merge(alpi_reference_value *value, const alpi_reference_value *fresh, double had,
                      double more);

/// Share of the texels with noisy direct light.
/// @param wanted root mean square error, W·m⁻²
double alpi_light_noisy_share(const alpi_light_rounds *rounds, double wanted);
/// Samples or rays of a listed texel, weighted by its squared error.
/// @param counts    [texels]
/// @param otherwise returned if there is no error
double alpi_light_typical(const alpi_reference_value *values, const uint32_t *counts,
                          const uint32_t *list, uint32_t count, double otherwise);
/// Samples of a texel with direct light, weighted by its squared error.
double alpi_light_typical_samples(const alpi_light_rounds *rounds);

/// The aim of more samples.
typedef struct alpi_light_goal {
    double wanted;        // root mean square error, W·m⁻²
    bool each;            // of each texel, not of all together
    double most;          // samples of all texels, about
    const uint8_t *among; // [texels] not 0: may count as noisy; NULL: all may
    uint64_t seed;
} alpi_light_goal;

/// Adds samples of direct light, more of them at noisier texels.
/// @param added out: whether any texel got samples
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_add_samples(alpi_light_rounds *rounds, const alpi_light_goal *goal,
                                  bool *added);

#endif
