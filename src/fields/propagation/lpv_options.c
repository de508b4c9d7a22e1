// SPDX-License-Identifier: MIT
// Options of a volume: their defaults, those that fit a scene, and which are refused; and the
// scheme of each mode.
#include "fields/propagation/lpv.h"

#include <math.h>

enum { ITERATIONS_MOST = 4096 };
static const double CELL_LEAST = 1e-6, CELL_MOST = 1e12; // metres

alpi_lpv_scheme alpi_lpv_scheme_of(alp_lpv_mode mode)
{
    const float along = (float)ALP_LPV_ALONG, aside = (float)ALP_LPV_ASIDE;
    switch (mode) {
    case ALP_LPV_CONFORMANCE:
        return (alpi_lpv_scheme){1.0f, along, aside, 0.0f, 1.0f, 1.0f, false};
    case ALP_LPV_TRANSFER:
        return (alpi_lpv_scheme){(float)ALP_LPV_MEAN_FAR,
                                 (float)ALP_LPV_MEAN_ALONG,
                                 (float)ALP_LPV_MEAN_ASIDE,
                                 0.0f,
                                 1.0f,
                                 1.0f,
                                 false};
    default:
        return (alpi_lpv_scheme){1.0f, along, aside, along, aside, (float)ALP_LPV_OPACITY, true};
    }
}

// --- options -------------------------------------------------------------------------------------

alp_lpv_options alp_lpv_options_default(void)
{
    return (alp_lpv_options){.struct_size = sizeof(alp_lpv_options),
                             .size = {32, 32, 32},
                             .cell = 0.25,
                             .cascades = 1,
                             .blockers = true,
                             .bounces = ALP_BOUNCES_CONVERGE};
}

/// Cell of the finest grid, where the coarsest has `grid` cells along a length in metres. Centres
/// are rounded to cells, by half a cell at most: 3 cells make room on both sides. 1 m for a length
/// of 0.
static double fit_cell(double length, uint32_t grid, uint32_t cascades)
{
    const double cell = grid > 3 ? length / (double)(grid - 3) : length;
    return cell > 0.0 ? ldexp(cell, 1 - (int)cascades) : 1.0;
}

alp_lpv_options alp_lpv_options_for_scene(const alp_scene *scene, uint32_t grid, uint32_t cascades)
{
    alp_lpv_options o = alp_lpv_options_default();
    const alp_scene_info info = alp_scene_get_info(scene);
    double longest = 0.0;
    for (int k = 0; k < 3; k++) {
        const double low = (double)info.bounds_min[k], high = (double)info.bounds_max[k];
        o.size[k] = grid;
        o.centre[k] = 0.5 * (low + high);
        longest = fmax(longest, high - low);
    }
    o.cascades = cascades;
    o.cell = fit_cell(longest, grid, cascades);
    return o;
}

/// Cells from the eye to a side of a grid, less one that stays empty and half a one for rounding.
/// Small grids have no room for these.
/// @param share of half a grid that lies on that side
static double find_room(uint32_t grid, double share)
{
    const double cells = 0.5 * (double)grid * share;
    return fmax(cells - 1.5, 0.25 * cells);
}

alp_lpv_options alp_lpv_options_for_view(const alp_scene *scene, uint32_t grid, uint32_t cascades,
                                         const double eye[3], const double forward[3])
{
    alp_lpv_options o = alp_lpv_options_for_scene(scene, grid, cascades);
    const alp_scene_info info = alp_scene_get_info(scene);
    const double length = hypot(hypot(forward[0], forward[1]), forward[2]);
    double cell = 0.0;
    for (int k = 0; k < 3; k++) {
        const double low = (double)info.bounds_min[k], high = (double)info.bounds_max[k];
        const double ahead = length > 0.0 ? ALP_LPV_AHEAD * (forward[k] / length) : 0.0;
        o.centre[k] = fmin(fmax(eye[k], low), high);
        cell = fmax(cell, (high - o.centre[k]) / find_room(grid, 1.0 + ahead));
        cell = fmax(cell, (o.centre[k] - low) / find_room(grid, 1.0 - ahead));
    }
    o.cell = cell > 0.0 ? ldexp(cell, 1 - (int)cascades) : 1.0;
    return o;
}

uint64_t alp_lpv_memory(const alp_lpv_options *o)
{
    const uint64_t cells = alpi_lpv_cells(o->size), nodes = alpi_lpv_nodes(o->size);
    const uint64_t light = 2 * ALPI_LPV_ROWS * (cells + alpi_lpv_wide_cells(o->size));
    const uint64_t blockers = (3 * ALPI_LPV_AXIS_ROWS + 2 * ALPI_LPV_NODE_TERMS) * nodes;
    return o->cascades * sizeof(float) * (light + (o->blockers ? blockers : 0));
}

alp_result alpi_lpv_check_options(alp_context *context, const alp_lpv_options *o)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (o->struct_size != sizeof *o) {
        return alpi_fail(context, code, "lpv options are not from _default()");
    }
    if (!(o->cell >= CELL_LEAST && o->cell <= CELL_MOST)) {
        return alpi_fail(context, code, "lpv: cells of %g m, need a size from %g to %g", o->cell,
                         CELL_LEAST, CELL_MOST);
    }
    for (int k = 0; k < 3; k++) {
        if (o->size[k] < 1 || o->size[k] > ALPI_LPV_SIDE_MOST) {
            return alpi_fail(context, code, "lpv: a grid of %u cells along a side, need 1 to %d",
                             o->size[k], ALPI_LPV_SIDE_MOST);
        }
        if (!isfinite(o->centre[k]) || fabs(o->centre[k]) > ALPI_LPV_FARTHEST * o->cell) {
            return alpi_fail(context, code, "lpv: centre %g, %g, %g is beyond 2^40 cells",
                             o->centre[0], o->centre[1], o->centre[2]);
        }
    }
    if (o->cascades < 1 || o->cascades > ALPI_LPV_CASCADES_MOST) {
        return alpi_fail(context, code, "lpv: %u cascades, need 1 to %d", o->cascades,
                         ALPI_LPV_CASCADES_MOST);
    }
    if (o->iterations > ITERATIONS_MOST) {
        return alpi_fail(context, code, "lpv: %u iterations, need at most %d", o->iterations,
                         ITERATIONS_MOST);
    }
    if ((int)o->mode < 0 || o->mode >= ALP_LPV_MODE_COUNT) {
        return alpi_fail(context, code, "lpv: unknown mode %d", (int)o->mode);
    }
    if (o->bounces != 1 && o->bounces != ALP_BOUNCES_CONVERGE) {
        return alpi_fail(context, code, "lpv: %u bounces, need 1 or ALP_BOUNCES_CONVERGE",
                         o->bounces);
    }
    const uint64_t bytes = alp_lpv_memory(o);
    if (o->memory_limit > 0 && bytes > o->memory_limit) {
        return alpi_fail(context, ALP_ERROR_LIMIT,
                         "lpv: the volume needs %.0f MB, the limit is %.0f MB; take fewer cells",
                         (double)bytes / 1e6, (double)o->memory_limit / 1e6);
    }
    return ALP_OK;
}
