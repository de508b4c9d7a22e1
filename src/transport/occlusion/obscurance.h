// SPDX-License-Identifier: MIT
// Receivers → coloured obscurance: occlusion that lets the colour of near surfaces bleed.
//
//     W = (1/π) ∫ [ (1 − w) + w · albedo of the hit ] (n·ω) dω,   w = w(distance of the hit /
//     limit)
//
// per channel, over the directions of occlusion and normalised like it. Open is white, and with
// albedo 0 everywhere W is the accessibility. A single-sided surface is black from behind.
// Based on: Zhukov, Iones, Kronin. An Ambient Light Illumination Model. EGWR 1998;
//           A. Méndez, M. Sbert, J. Catà. Real-time Obscurances with Color Bleeding. SCCG 2003.
#ifndef ALPI_TRANSPORT_OBSCURANCE_H
#define ALPI_TRANSPORT_OBSCURANCE_H

#include "transport/occlusion/occlusion.h"

/// Obscurance of the receivers in `list` (as alpi_occlusion_add takes them) from the first
/// `samples` of the setup's: the rays of occlusion, asked for their nearest hit. Unbiased; the
/// weight is taken at the hit's distance, so noise is a little lower than that of occlusion with a
/// fall-off.
/// @param samples  a multiple of ALPI_QUARTERS, at most setup->samples
/// @param progress NULL, or what to tell; units are filled in here, in rays
/// @param sums     [receivers->count] with vectors, zero for those of the list, not so after
/// @param rgb      [receivers->count] out, [0, 1]; only those of the list are written, on ALP_OK
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_obscurance_gather(const alpi_occlusion_setup *setup,
                                  const alpi_receivers *receivers, const uint32_t *list,
                                  uint32_t list_count, uint32_t samples,
                                  const alpi_task_progress *progress, alpi_occlusion_sums *sums,
                                  float (*rgb)[3]);

#endif
