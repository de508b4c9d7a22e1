// SPDX-License-Identifier: MIT
// Direct light of texels, of which some are known by more samples than others.
#ifndef ALPI_BAKE_LIGHT_DIRECT_H
#define ALPI_BAKE_LIGHT_DIRECT_H

#include "bake/light/light.h"

typedef struct alpi_light_direct {
    alpi_bake_job *job;
    const alpi_light_task *task;
    const alpi_radiosity *solution;      // with its direct light by direction
    alpi_reference_value *values;        // [texels] of the solution
    alpi_reference_value *fresh;         // [texels] scratch
    alpi_directional *fresh_directional; // [texels] the same; NULL: not wanted
    uint32_t *counts;                    // [texels] samples so far; 0: it has no light of its own
    uint32_t most;                       // of those that have the most
    double limit;                        // that any may have
    double power;                        // of samples, that the error falls with
    double foreseen;                     // root mean square of the errors after more of them
    double seconds;                      // of a sample more of a texel
    double drawn;                        // samples in rounds so far, of all texels together
} alpi_light_direct;

/// Share of the texels whose direct light is noisy.
/// @param wanted root mean square of the errors that would do, W·m⁻²
double alpi_light_noisy_share(const alpi_light_direct *direct, double wanted);

/// Samples of a texel, weighed by what it has of the squared error.
double alpi_light_typical_samples(const alpi_light_direct *direct);

/// What more samples are for.
typedef struct alpi_light_goal {
    double wanted;        // root mean square of the errors that would do, W·m⁻²
    bool each;            // of each texel alone, not of all together
    double most;          // samples of all texels together, about
    const uint8_t *among; // [texels] NULL, or not 0: of those that may count as noisy
    uint64_t seed;
} alpi_light_goal;

/// Gives texels more samples, those with more noise more of them.
/// @param dealt out: whether any texel got more
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_more_direct(alpi_light_direct *direct, const alpi_light_goal *goal,
                                  bool *dealt);

#endif
