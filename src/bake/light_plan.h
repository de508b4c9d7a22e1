// SPDX-License-Identifier: MIT
// What a round of light adds, so that an error is reached at the least cost.
#ifndef ALPI_BAKE_LIGHT_PLAN_H
#define ALPI_BAKE_LIGHT_PLAN_H

#include <stdint.h>

/// What was done so far.
typedef struct alpi_light_effort {
    double direct, rays; // samples of a texel: of those that have the most
    double most;         // that either may become
    double texels;       // whose direct light is looked for
    double traced;       // that send rays
} alpi_light_effort;

/// Errors of the two kinds of light, over a mean: those of the whole map, or of the texels that err
/// most.
typedef struct alpi_light_noise {
    double direct, bounced;
    double noisy; // share of the texels that more samples of direct light would go to, about
} alpi_light_noise;

/// What a round adds: samples of direct light, and rays.
typedef struct alpi_light_plan {
    double direct, rays; // 0: none
    double for_direct;   // error that direct light would have then
    double cost;
    double noisy; // share of the texels that more direct light is for, about
} alpi_light_plan;

/// The cheapest way to an error.
/// @param aim for both kinds of light together: √(direct² + bounced²)
alpi_light_plan alpi_light_cheapest(const alpi_light_effort *effort, const alpi_light_noise *noise,
                                    double aim);

#endif
