// SPDX-License-Identifier: MIT
// What a look-up in a lightmap reads: which texels, and how much of each.
#ifndef ALPI_MAPS_LOOKUP_H
#define ALPI_MAPS_LOOKUP_H

#include "maps/lightmap.h"

enum { ALPI_LOOKUP_LIMIT = 12 }; // three bilinear ones

/// Value = Σ weights · texels; the weights add up to 1.
typedef struct alpi_lookup {
    uint32_t count;
    size_t texels[ALPI_LOOKUP_LIMIT]; // (page · height + y) · width + x, not all unlike
    double weights[ALPI_LOOKUP_LIMIT];
} alpi_lookup;

/// The look-up that alpi_lightmap_sample makes at a point of a triangle that lies on a page.
void alpi_lookup_at(const alp_lightmap *lightmap, uint32_t triangle, double b1, double b2,
                    alpi_lookup *lookup);

#endif
