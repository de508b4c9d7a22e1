// SPDX-License-Identifier: MIT
// Direct light of a sky's bright spots at a receiver.
//
// The spots are a fixed list of looks, each in a direction ω_k with a light l_k, so that
// E = Σ l_k max(n·ω_k, 0) V_k with visibility V. For the normal n of a receiver a prefix sum over
// blocks of looks lets any number of them be drawn in proportion to max(n·ω_k, 0), all their light
// being alike within a factor of 2: visibility, and hue, are left to chance. A replicate's draws
// lie at even distances along the list, whose looks are neighbours as they follow each other. The
// replicates go along it together, so that the rays of a packet are nearly parallel.
//
// What there is without anything in between, E₀ = Σ l_k max(n·ω_k, 0), is known. So where a
// receiver is flat, E = E₀ Σ l V / Σ l over the draws: what sees all spots, or none, has no noise.
// A ratio of means; its bias is far below its noise.
//
// Where normals differ, looks are drawn by max(n·ω_k + s, 0), s no less than |n' − n| for all
// normals n' of some points: n'·ω_k is above that for none of them. Panes are not seen to: who asks
// for spots alone has none.
#ifndef ALPI_TRANSPORT_DIRECT_SPOTS_H
#define ALPI_TRANSPORT_DIRECT_SPOTS_H

#include "scene/sky/sky_spots.h"
#include "transport/direct/direct.h"

/// Looks that are drawn for a normal.
typedef struct alpi_spot_choice {
    const alpi_sky_looks *looks;   // NULL: none yet
    vec3 normal;                   // unit
    float slack;                   // s, ≥ 0
    double ends[ALPI_LOOK_BLOCKS]; // sum of the weights up to the end of each block
    double total;                  // of all weights; 0: all spots are below the horizon
    double open[3];                // E₀, W·m⁻²; of slack 0 only
    uint32_t weighed;              // the block picked from last; ALPI_NONE: none
    float weights[ALPI_LOOK_BLOCK], look_ends[ALPI_LOOK_BLOCK]; // of it, and their sums
} alpi_spot_choice;

/// Makes a choice, unless it is made already.
void alpi_spots_choose(const alpi_sky_looks *looks, vec3 normal, float slack,
                       alpi_spot_choice *choice);
/// Blocks, first and last, that places lie in.
typedef struct alpi_spot_range {
    uint32_t first, last;
} alpi_spot_range;
/// Where to search for places from where a range ends up to `to`. @param before {0, 0}: from 0
alpi_spot_range alpi_spots_narrow(const alpi_spot_choice *choice, alpi_spot_range before,
                                  double to);
/// The look at a place within [0, total) and the range. @param weight out, > 0
uint32_t alpi_spots_pick(alpi_spot_choice *choice, alpi_spot_range range, double place,
                         float *weight);

/// The draws at a receiver.
typedef struct alpi_spot_gather {
    alpi_spot_choice choice;
    alpi_spot_range range;                   // of the draws last aimed
    double begins[ALPI_DIRECT_REPLICATES];   // of the first draw, within the first of even shares
    double drawn[ALPI_DIRECT_REPLICATES][3]; // what draws would bring if all were free
    alpi_directional_found found;
} alpi_spot_gather;

#endif
