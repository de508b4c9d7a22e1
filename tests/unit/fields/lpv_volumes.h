// SPDX-License-Identifier: MIT
// Volumes for tests, and the flux in them.
#ifndef LPV_VOLUMES_H
#define LPV_VOLUMES_H

#include "fields/propagation/lpv.h"
#include "test_support.h"

/// Options of grids of side³ cells.
static inline alp_lpv_options lpv_cube(uint32_t side, double cell)
{
    alp_lpv_options o = alp_lpv_options_default();
    o.size[0] = o.size[1] = o.size[2] = side;
    o.cell = cell;
    return o;
}

/// A volume that is ready for its first light.
static inline alp_lpv *lpv_open(alp_context *context, alp_lpv_options options)
{
    alp_lpv *lpv = NULL;
    ASSERT_OK(context, alp_lpv_create(context, &options, &lpv));
    alp_lpv_begin(lpv);
    return lpv;
}

/// Flux of the first channel in a grid: 4π Σ p0. @param rows its `injected` or `sum`
static inline double lpv_flux(const alpi_lpv_grid *g, const float *rows)
{
    const size_t n = g->size[0], count = (size_t)g->size[1] * g->size[2];
    double sum = 0.0;
    for (size_t r = 0; r < count; r++) {
        for (size_t x = 0; x < n; x++) {
            sum += (double)rows[r * ALPI_LPV_ROWS * n + x];
        }
    }
    return 4.0 * 3.14159265358979323846 * sum;
}

/// Injects one surfel as light of the same flux in all channels.
static inline void lpv_add_one(alp_context *context, alp_lpv *lpv, const float position[3],
                               const float normal[3], float flux)
{
    const float fluxes[1][3] = {{flux, flux, flux}};
    const float p[1][3] = {{position[0], position[1], position[2]}};
    const float n[1][3] = {{normal[0], normal[1], normal[2]}};
    const alp_lpv_surfels s = {.count = 1, .positions = p, .normals = n, .flux = fluxes};
    ASSERT_OK(context, alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s));
}

#endif
