// SPDX-License-Identifier: MIT
// Direct light of a few even polygons: the closed form of each, as far as rays find it visible.
//
// E = Σ π L F̄ V, where F̄ is the mean, over the points of the receiver, of the closed form factor
// above their horizon, and V = Σ c v / Σ c over rays to points of the polygon, with v = 1 where a
// ray is free and c the light that it would bring. Where all rays agree, as where a polygon is
// wholly visible or hidden, V has no noise. It is a ratio of means: its bias, where rays disagree,
// falls as 1 / samples, and is far below its noise (16 samples of a half hidden quad: below 1 %,
// noise 11 %; test_direct_polygons.c).
//
// Points of a polygon are of even density over its area, which is fast; for a receiver closer than
// its diameter, over its solid angle; where none of them was above the horizon, over what is.
// Based on: D. R. Baum, H. E. Rushmeier, J. M. Winget. Improving Radiosity Solutions Through the
// Use of Analytically Determined Form-Factors. SIGGRAPH 1989;
//           E. Heitz, S. Hill, M. McGuire. Combining Analytic Direct Illumination and Stochastic
// Shadows. I3D 2018.
#ifndef ALPI_TRANSPORT_DIRECT_POLYGONS_H
#define ALPI_TRANSPORT_DIRECT_POLYGONS_H

#include "transport/direct/direct.h"
#include "transport/direct/direct_emitters.h"
#include "transport/direct/direct_polygon_kernel.h"

enum { ALPI_POLYGON_LIMIT = ALPI_DIRECT_FEW };

/// Polygons of the emitters of a scene, in their order: two triangles that make a parallelogram are
/// one. None where the emitters are many, or any of them is not even: textured, blended or cut.
/// @param parts of the materials: see alpi_direct
/// @return how many
uint32_t alpi_polygons_collect(const alpi_direct_emitters *emitters, const uint32_t *parts,
                               alpi_polygon polygons[ALPI_POLYGON_LIMIT]);

/// What gathers the light of polygons at eight receivers, by one worker.
typedef struct alpi_polygon_gather {
    const alpi_direct_options *options;
    const alpi_receivers *receivers;
    uint32_t samples; // of each polygon at each receiver, a multiple of the replicates
    const alpi_polygon *polygons;
    uint32_t polygon_count;
    const alpi_polygon_loops *loops;
    uint64_t rays; // sent: added to
    /// Out: form factor × visibility, summed over the samples of each replicate; of one half of the
    /// samples, where that is all there is, twice, and as far apart as the error of a half is
    /// large.
    double sums[ALPI_PACKET][ALPI_POLYGON_LIMIT][ALPI_DIRECT_REPLICATES][3];
    bool above;        // its own: rays go to what is above the horizon alone
    bool by_direction; // then this too:
    alpi_directional_found directional[ALPI_PACKET][ALPI_POLYGON_LIMIT];
    // Its own.
    uint32_t wanted[ALPI_POLYGON_LIMIT][ALPI_POLYGON_HALVES]; // bit i: by lane i
    uint8_t scouts[ALPI_POLYGON_LIMIT][2];                    // whether any was free, any stopped
    uint32_t missed[ALPI_POLYGON_LIMIT]; // bit i: no ray of lane i went to what it sees
    uint32_t halved[ALPI_POLYGON_LIMIT]; // bit i: lane i has one half of its samples, twice
    uint32_t keys[ALPI_POLYGON_HALVES][ALPI_PACKET];
    alpi_receiver_point placed[ALPI_POLYGON_CHUNK];
    alpi_polygon_wave wave;
    alpi_polygon_tally tallies[ALPI_POLYGON_LIMIT];
} alpi_polygon_gather;

/// Whether the halves of a lane's samples of a part of the light tell nothing of each other.
static inline bool alpi_polygons_repeat(const alpi_polygon_gather *gather, uint32_t lane,
                                        uint32_t part)
{
    bool any = false;
    for (uint32_t k = 0; k < gather->polygon_count; k++) {
        any = any || (gather->polygons[k].part == part && (gather->halved[k] >> lane & 1u) != 0);
    }
    return any;
}

/// The most rays that a polygon takes at so many receivers, up to eight, side by side.
double alpi_polygon_rays(uint32_t samples, uint32_t receivers);

/// Readies all but the polygons and whether light is wanted by direction, which are the caller's to
/// set. @param samples see above
void alpi_polygons_start(const alpi_direct_options *options, const alpi_receivers *receivers,
                         uint32_t samples, alpi_polygon_gather *gather);

/// Fills `sums` of up to eight receivers, best if neighbours: where one finds a penumbra, the
/// others take more samples too. @return ALP_OK; CANCELLED
alp_result alpi_polygons_gather(alpi_polygon_gather *gather, const uint32_t *receivers,
                                uint32_t count);

#endif
