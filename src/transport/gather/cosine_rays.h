// SPDX-License-Identifier: MIT
// Gathering by rays: stratified, cosine-distributed directions from points spread over a receiver,
// so that all rays count alike, E = π/N Σ L.
#ifndef ALPI_TRANSPORT_COSINE_RAYS_H
#define ALPI_TRANSPORT_COSINE_RAYS_H

#include "transport/gather/gather.h"

/// Replicates have the same number of packets. Apart, each has a sequence of its own, and the
/// spread of their means tells the error. Joined, each is a run of one sequence, which is as well
/// stratified as one replicate: half the variance of four apart (64 to 256 rays in a box), but
/// their spread tells as much as before, which is too much by a factor that depends on what is
/// seen.
typedef struct alpi_cosine_rays {
    alp_context *context; // for its instruction set
    uint32_t samples;     // of each receiver: a multiple of 8 × replicates
    uint32_t replicates;  // [1, ALPI_GATHER_REPLICATE_LIMIT]
    bool joined;
    uint64_t seed;
} alpi_cosine_rays;

/// `samples` rounded up to what there can be.
uint32_t alpi_cosine_rays_samples(uint32_t samples, uint32_t replicates);

/// Unbiased. The options are borrowed.
alpi_gatherer alpi_cosine_rays_gatherer(const alpi_cosine_rays *rays);

#endif
