// SPDX-License-Identifier: MIT
// A light propagation volume: its grids, and how its files share them.
#ifndef ALPI_FIELDS_LPV_H
#define ALPI_FIELDS_LPV_H

#include "base/vec.h"
#include "fields/propagation/lpv_grid.h"

#include <math.h>

/// Cells from the origin that a grid may lie at: a double holds a thousandth of one there.
#define ALPI_LPV_FARTHEST 1099511627776.0
/// A place among the eight cells, or nodes, from `low` ≥ −1 on.
typedef struct alpi_lpv_place {
    int16_t low[3];
    bool usable, held;    // any grid can hold the surfel; the present one does
    bool lights;          // a grid holds it, and it has flux
    float part[3], share; // of the upper cells; of the light that goes there
} alpi_lpv_place;

struct alp_lpv {
    alp_context *context;
    alp_lpv_options options;
    uint32_t iterations;
    bool wraps;                    // tests: light that leaves on one side enters on the other
    double eye[3];                 // metres, of the last alp_lpv_follow; the centre before
    double forward[3];             // unit, or 0
    uint64_t skipped, lit, lights; // surfels since `begin`: left out; with flux; and held
    alpi_lpv_place *places;        // [place_limit] of the surfels that are being added
    uint32_t *order;               // [order_limit] of surfels, by layers
    size_t place_limit, order_limit;
    alpi_lpv_grid grids[ALPI_LPV_CASCADES_MOST];
};

/// @return ALP_OK; INVALID_ARGUMENT or LIMIT, with a message
alp_result alpi_lpv_check_options(alp_context *context, const alp_lpv_options *options);

/// Centre of grid `cascade` before it is rounded to whole cells, in metres.
void alpi_lpv_ideal_centre(const alp_lpv *lpv, uint32_t cascade, double centre[3]);

/// How grids give way to coarser ones: a share is 1 inside of a grid and 0 a cell before its
/// border. It follows the eye itself, not the grid that moves by whole cells behind it, so that
/// nothing jumps when the grid moves.
typedef struct alpi_lpv_fades {
    uint32_t count;                                                          // of grids
    double centre[ALPI_LPV_CASCADES_MOST][3], cells[ALPI_LPV_CASCADES_MOST]; // metres; per metre
    double half[3], slope[3]; // cells, and the share's change a cell
} alpi_lpv_fades;
/// @param border share of half a grid, (0, 1], over which it fades
alpi_lpv_fades alpi_lpv_find_fades(const alp_lpv *lpv, double border);

static inline double alpi_lpv_share(const alpi_lpv_fades *f, uint32_t cascade, const double p[3])
{
    double least = 1.0;
    for (int k = 0; k < 3; k++) {
        const double away = fabs(p[k] - f->centre[cascade][k]) * f->cells[cascade];
        const double share = (f->half[k] - away) * f->slope[k];
        least = share < least ? share : least;
    }
    return least > 0.0 ? least : 0.0;
}

#endif
