// SPDX-License-Identifier: MIT
// The innermost loop of occlusion: eight receivers, one point of each, many directions.
#ifndef ALPI_TRANSPORT_OCCLUSION_KERNEL_H
#define ALPI_TRANSPORT_OCCLUSION_KERNEL_H

#include "transport/occlusion.h"

/// Eight points, structure of arrays. Lane i of every packet belongs to point i: neighbours send
/// the same sample in nearly the same direction, which is what packets are good at.
typedef struct alpi_occlusion_lanes {
    _Alignas(32) float origin[3][ALPI_PACKET]; // offset included
    float normal[3][ALPI_PACKET];              // unit, the hemisphere's axis
    // Digital shifts of the samples' coordinates. The top bits of the first two are turned over:
    // their fractions, read as signed numbers, lie in [−1, 1).
    uint32_t shift[3][ALPI_PACKET];
    // The kernel's: kept here so that what never changes stays.
    alpi_rays rays[ALPI_TRACE_BATCH];
    uint32_t active;  // bit i: lane i is in use; the others hold copies of one that is
    uint32_t pending; // packets made and not traced yet, of one point or of several
    float cosine;     // least of those between the axes of a packet, of all that are pending
} alpi_occlusion_lanes;

/// Readies the lanes for any points; which are in use is the caller's to set.
void alpi_occlusion_lanes_start(alpi_occlusion_lanes *lanes);

/// What the rays of eight points met.
typedef struct alpi_occlusion_tally {
    _Alignas(32) uint32_t open[ALPI_PACKET]; // rays that were free
    float sum[3][ALPI_PACKET];               // Σ of their directions, or of colours
} alpi_occlusion_tally;

/// Sends `count` samples of a sequence from each of the lanes and adds to the tally. `samples` are
/// [count][3] 32-bit fractions: two for the direction, one for the distance. The same code compiled
/// for any machine, and for x86-64-v3. Packets wait until a batch of them is full: in the end a
/// call with no samples sends the rest. No fused operations in either: the same bits.
alpi_occlusion_kernel alpi_occlusion_kernel_baseline, alpi_occlusion_kernel_v3;

/// Coloured obscurance instead: adds (1 − w) + w · albedo of what each ray hits to tally->sum, and
/// counts rays that hit nothing as open.
alpi_occlusion_kernel alpi_obscurance_kernel;

#endif
