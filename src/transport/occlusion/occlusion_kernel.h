// SPDX-License-Identifier: MIT
// The innermost loop of occlusion: one receiver, many directions from points of it.
#ifndef ALPI_TRANSPORT_OCCLUSION_KERNEL_H
#define ALPI_TRANSPORT_OCCLUSION_KERNEL_H

#include "transport/occlusion/occlusion_run.h"

/// Eight points of a receiver, structure of arrays: lane i of a packet leaves from point i.
typedef struct alpi_occlusion_lanes {
    _Alignas(32) float origin[3][ALPI_PACKET];                // offset included
    float normal[3][ALPI_PACKET];                             // unit, the hemisphere's axis
    float tangent[3][ALPI_PACKET], bitangent[3][ALPI_PACKET]; // the kernel's to make
} alpi_occlusion_lanes;

/// Receivers whose packets of a chunk go together, and what stays from one to the next.
typedef struct alpi_occlusion_stand {
    alpi_occlusion_lanes groups[ALPI_CHUNK_GROUPS]; // of receiver r from r times the chunk's on
    // Digital shifts of the samples' coordinates. The top bits of the first two are turned over:
    // their fractions, read as signed numbers, lie in [−1, 1).
    uint32_t shifts[ALPI_PACKET][3];
    uint32_t receivers; // at most ALPI_PACKET; 1 where the chunk's last packet leaves lanes out
    // Of a batch: packet k is a half, number k % 2, of pair k / 2 where it is traced in pairs, else
    // it is one of the rays, number k.
    alpi_ray_pair pairs[ALPI_TRACE_BATCH / 2];
    alpi_rays rays[ALPI_TRACE_BATCH];
} alpi_occlusion_stand;

/// Readies a stand for any receivers of a setup.
void alpi_occlusion_stand_start(const alpi_occlusion_setup *setup, alpi_occlusion_stand *stand);

/// What a receiver's rays of a chunk met, by lane.
typedef struct alpi_occlusion_tally {
    _Alignas(32) uint32_t open[ALPI_PACKET]; // rays that were free
    float sum[3][ALPI_PACKET];               // Σ of their directions, or of colours
} alpi_occlusion_tally;

/// Sends the packets of a chunk from every receiver of `stand` and adds to its tally. The same code
/// compiled for any machine, and for x86-64-v3. No fused operations in either: the same bits.
/// @param tallies [receivers]
alpi_occlusion_kernel alpi_occlusion_kernel_baseline, alpi_occlusion_kernel_v3;

/// Coloured obscurance instead: adds (1 − w) + w · albedo of what each ray hits to tally->sum, and
/// counts rays that hit nothing as open.
alpi_occlusion_kernel alpi_obscurance_kernel;

#endif
