// SPDX-License-Identifier: MIT
// Plans the next round: which texels get how many samples of direct light and how many rays, so
// that the wanted error is reached at the least cost.
#ifndef ALPI_BAKE_LIGHT_PLAN_H
#define ALPI_BAKE_LIGHT_PLAN_H

#include "bake/light/light_error.h"
#include "bake/light/light_state.h"

/// A round: samples of direct light, and rays, of a texel.
typedef struct alpi_light_plan {
    double direct, rays; // 0: none
    double for_direct;   // error of direct light after the round
    double cost;
    double listed; // texels that the samples are for, about
} alpi_light_plan;

/// Plans the first round with a pilot, so that it is the last one if possible: a few texels trace
/// rays, and their noise gives the number for all. Adds the samples of direct light that this error
/// needs, so that rays read direct light without noise. Overwrites light->values and rounds->skies.
/// @param rays out: of a texel
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_run_pilot(alpi_light_rounds *rounds, uint32_t *rays);

/// Plans the next round, for all texels or for the worst; sets rounds->for_worst and worst.
/// @param plan out: nothing, if the error is reached, or nothing helps, or no rays are left
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_plan_round(alpi_light_rounds *rounds, alpi_light_plan *plan);

/// As many of `samples` as the time allows; 0 if these are too few beside those before.
double alpi_light_affordable(const alpi_light_rounds *rounds, double samples, double seconds_each,
                             double before);
/// Rays left of the limit. A sample of direct light counts as one, even if it traces none.
double alpi_light_rays_left(const alpi_light_rounds *rounds);

// --- parts, for tests ----------------------------------------------------------------------------

/// Work so far.
typedef struct alpi_light_effort {
    double direct, rays; // of a texel; direct: weighted by the squared error
    double most;         // of either
    double texels;       // with direct light
    double traced;       // that trace rays
    double direct_power; // errors fall with samples^−power
    double rays_power;
    double draw; // time of a sample of direct light, over that of a shadow ray
} alpi_light_effort;

/// The cheapest round that lowers √(direct² + bounced²) to `aim`.
alpi_light_plan alpi_light_cheapest(const alpi_light_effort *effort, const alpi_light_noise *noise,
                                    double aim);

#endif
