// SPDX-License-Identifier: MIT
// Two charts made one.
#ifndef ALPI_ATLAS_MERGE_H
#define ALPI_ATLAS_MERGE_H

#include "atlas/patch.h"
#include "atlas/stages.h"

/// Two charts that may become one.
typedef struct alpi_merge {
    alpi_patch_source source; // the triangles of both
    uint32_t first_count;     // of them those of the first chart
    double margin;            // metres that padding adds to each side of a box
    double room;              // m²: most that the box of both may have, with its margin
    double fill;              // least share of its box (without) that the chart has to fill
    bool merges;              // out
    double width, height;     // out: metres, of its box
} alpi_merge;

/// Unwraps two charts together, and writes corner_uvs (metres) if that is good: no triangle
/// flipped, none over another, stretch and box within bounds. Touches nothing of other charts: many
/// may run at once.
alp_result alpi_merge_attempt(alp_atlas *atlas, alpi_merge *merge);

#endif
