// SPDX-License-Identifier: MIT
// What a round of light adds, so that an error is reached at the least cost.
#ifndef ALPI_BAKE_LIGHT_PLAN_H
#define ALPI_BAKE_LIGHT_PLAN_H

#include <stdbool.h>
#include <stdint.h>

/// What was done so far.
typedef struct alpi_light_effort {
    double direct, rays; // samples of a texel; direct: of those whose error counts
    double most;         // that either may become
    double texels;       // whose direct light is looked for
    double traced;       // that send rays
    double direct_power; // of samples, that direct light's error falls with
    double rays_power;   // of rays, that bounced light's does
    double draw;         // time of a sample of direct light (alpi_direct_output)
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

/// That power, before anything is known of it: .5 is that of samples that know nothing of each
/// other, .53 to .64 was measured.
#define ALPI_LIGHT_FIRST_POWER 0.6
/// That of rays, which are one sequence: it falls faster than with their root. Measured, of rounds
/// that follow each other, .6 to .7; of one by more rays, whose lattice is finer too, .66 to .90,
/// of which the most is taken, as more samples than that are planned anyway.
#define ALPI_LIGHT_RAYS_POWER 0.62
#define ALPI_LIGHT_FIRST_RAYS_POWER 0.9
/// The power that more samples have shown, within what is ever seen: half, to three quarters, which
/// is that of stratified samples of an edge.
/// @param had      as it was taken to be
/// @param foreseen times the error before, by that power: < 1
/// @param error    times the error before, as it came
double alpi_light_power(double had, double foreseen, double error);

/// The cheapest way to an error.
/// @param aim for both kinds of light together: √(direct² + bounced²)
alpi_light_plan alpi_light_cheapest(const alpi_light_effort *effort, const alpi_light_noise *noise,
                                    double aim);

#endif
