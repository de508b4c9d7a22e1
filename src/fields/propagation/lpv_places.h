// SPDX-License-Identifier: MIT
// Places of surfels in the grids of a volume.
#ifndef ALPI_FIELDS_LPV_PLACES_H
#define ALPI_FIELDS_LPV_PLACES_H

#include "fields/propagation/lpv.h"

enum { ALPI_LPV_LAYERS_MOST = ALPI_LPV_SIDE_MOST + 4 };

/// Surfels on their way into the grids, one after the other.
typedef struct alpi_lpv_injection {
    alp_lpv *lpv;
    const alp_lpv_surfels *surfels;
    uint32_t cascade; // whose map the surfels are, or ALP_LPV_ALL_CASCADES
    bool blockers;    // into nodes, else into cells

    // The grid that is being filled, and its surfels:
    const alpi_lpv_grid *grid;
    uint32_t index;
    uint32_t ends[3];                      // cells or nodes along each axis
    uint32_t layers[ALPI_LPV_LAYERS_MOST]; // [z + 1] first of `order` whose lower layer is z
    alpi_lpv_fades fades;
} alpi_lpv_injection;

/// Makes room for all surfels, and finds those that are usable.
alp_result alpi_lpv_begin_places(alpi_lpv_injection *in);
/// Fills lpv->places, and lpv->order and `layers` with those that the grid holds.
alp_result alpi_lpv_find_places(alpi_lpv_injection *in, uint32_t index);
/// Adds to lpv->lights, when all grids have been filled.
void alpi_lpv_count_lights(const alpi_lpv_injection *in);

#endif
