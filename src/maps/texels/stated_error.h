// SPDX-License-Identifier: MIT
// How far a map is from the truth, said by rays that took no part in it.
//
// The error of quasi-Monte Carlo cannot be read off its own samples: parts of one sequence are not
// independent, and repeating independent shorter sequences instead costs up to a
// quarter more error (docs/measured/accuracy.md). The error of interpolation is in no sample at
// all. So some texels, chosen at random, are held out: each gets two estimates y₁, y₂ more,
// independent of the map's value x and of each other, and
//
//     E[(x − y₁)(x − y₂)] = (x − truth)²
//
// whatever x was made of. Each texel's share of it comes from the spread of the quarters of its
// samples, pooled over its neighbours.
#ifndef ALPI_MAPS_STATED_ERROR_H
#define ALPI_MAPS_STATED_ERROR_H

#include "maps/texels/chart_deal.h"
#include "maps/texels/lattice.h"
#include "transport/occlusion/occlusion.h"

/// Of a wanted error: a 99th percentile of texels' errors above so many times it asks for more rays
/// too.
#define ALPI_P99_LIMIT 4.0

/// Held-out texels with their two independent estimates.
typedef struct alpi_probes {
    alp_context *context;
    const alpi_receivers *base;
    uint32_t count;
    uint32_t *texels;               // [count]
    uint32_t *list;                 // [count] probes, in the order they are traced in
    alpi_occlusion_setup setups[2]; // the map's, with other random numbers
    alpi_occlusion_sums sums[2];
} alpi_probes;

/// Chooses `count` of the texels in `order`, evenly and at random.
alp_result alpi_probes_create(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              const uint32_t *order, uint32_t order_count, uint32_t count,
                              alpi_probes *probes);
/// Has them traced chart by chart: faster, and the same.
void alpi_probes_deal(alpi_probes *probes, alpi_chart_deal *deal);
void alpi_probes_destroy(alpi_probes *probes);
/// Sends samples [first, first + count) from all of them.
alp_result alpi_probes_add(alpi_probes *probes, uint32_t first, uint32_t count, uint32_t total,
                           const alpi_task_progress *progress);

/// Standard errors of the texels in `order`.
/// @param sums   what the traced texels of the lattice met
/// @param errors   [texels] out; OPEN texels get 0
/// @param progress NULL, or who is asked whether to go on
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED: `errors` are none
alp_result alpi_state_errors(const alpi_probes *probes, const alpi_lattice *lattice,
                             const alpi_occlusion_sums *sums, const uint32_t *order,
                             uint32_t order_count, const alpi_task_progress *progress,
                             float *errors);

/// The error of a map in one number, over the mean of its values: of the texels in an order that
/// have a value, each counting alike; 0 where there are none.
typedef struct alpi_relative_error {
    double rms; // √ mean of squares of the standard errors
    double p99; // their 99th percentile
} alpi_relative_error;
alp_result alpi_find_relative_error(const alpi_lattice *lattice, const float *errors,
                                    const uint32_t *order, uint32_t order_count,
                                    const alpi_task_progress *progress,
                                    alpi_relative_error *relative);

/// The smallest value that `share` of the texels in `order` do not exceed.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED by who watches the context
alp_result alpi_percentile(alp_context *context, const float *values, const uint32_t *order,
                           uint32_t order_count, double share, double *value);

/// Variance of the mean of a receiver's quarters, as if they were independent: too large by a
/// factor that is much the same for all receivers.
double alpi_spread_variance(const alpi_occlusion_sums *sums, uint32_t receiver);

#endif
