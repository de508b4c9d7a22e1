// SPDX-License-Identifier: MIT
// Places of surfels: which are usable, the share of each that a grid takes, and the cells that
// share it. Places are sorted by layers of the grid for the workers that add them.
#include "fields/propagation/lpv_places.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { GRAIN = 4096 };
/// Largest area of a surfel in faces of a cell, and flux in W and in W for each m² of a face: sums
/// of 2^32 surfels over all steps stay finite.
static const float FACES_MOST = 1e20f, RADIANCE_MOST = 1e20f;

// --- what is usable ------------------------------------------------------------------------------

static bool is_good(const float v[3], float least, float most)
{
    bool good = true;
    for (int k = 0; k < 3; k++) {
        good = good && isfinite(v[k]) && v[k] >= least && v[k] <= most;
    }
    return good;
}

static bool is_usable(const alpi_lpv_injection *in, uint32_t i)
{
    const alp_lpv_surfels *s = in->surfels;
    const float *n = s->normals[i];
    const float squares = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    const float cell = (float)in->lpv->options.cell, face = cell * cell;
    bool good = is_good(s->positions[i], -FLT_MAX, FLT_MAX) && squares > 0.98f && squares < 1.02f;
    if (in->blockers) {
        good = good && s->areas[i] >= 0.0f && s->areas[i] <= FACES_MOST * face;
        good = good && (s->albedo == NULL || is_good(s->albedo[i], 0.0f, 1.0f));
    } else {
        good = good && is_good(s->flux[i], 0.0f, RADIANCE_MOST * fminf(face, 1.0f));
    }
    return good && (s->radii == NULL || isfinite(s->radii[i]));
}

/// Whether a surfel, which is usable, sends light.
static bool has_flux(const alpi_lpv_injection *in, uint32_t i)
{
    const float *f = in->blockers ? NULL : in->surfels->flux[i];
    return f != NULL && (f[0] > 0.0f || f[1] > 0.0f || f[2] > 0.0f);
}

// --- places --------------------------------------------------------------------------------------

/// Share that the coarsest of several grids takes: its last cell fades, or light would jump where
/// the grid moves on. alp_lpv_options_for_scene leaves that cell empty. A single grid takes all.
static double find_last_share(const alpi_lpv_fades *f, const double p[3])
{
    const uint32_t last = f->count - 1;
    double least = 1.0;
    for (int k = 0; k < 3 && last > 0; k++) {
        const double away = fabs(p[k] - f->centre[last][k]) * f->cells[last];
        least = f->half[k] >= 1.0 ? fmin(least, f->half[k] + 0.5 - away) : least;
    }
    return fmax(least, 0.0);
}

/// Share of a surfel's light that a grid takes. Maps of cascades are blended as the grids are.
static double find_weight(const alpi_lpv_injection *in, const float position[3])
{
    const double p[3] = {(double)position[0], (double)position[1], (double)position[2]};
    const alpi_lpv_fades *f = &in->fades;
    const bool all = in->cascade == ALP_LPV_ALL_CASCADES;
    const uint32_t map = all ? in->index : in->cascade;
    double finer = 1.0; // what finer maps leave
    for (uint32_t c = 0; c < map; c++) {
        finer *= 1.0 - alpi_lpv_share(f, c, p);
    }
    const double own = map + 1 == f->count ? find_last_share(f, p) : alpi_lpv_share(f, map, p);
    return all ? 1.0 - finer * (1.0 - own) : finer * own;
}

/// Share of the upper of two cells. Along its normal a surfel lies in one cell, or light would get
/// behind its surface. Aside it is shared by distance, or light would jump as it moves.
/// @param part of the way from centre to centre   @param n component of the normal
static double find_part(double part, double n)
{
    const double wide = 1.0 - n * n, from = part - 0.5 * (1.0 - wide); // of the way, in its middle
    return from <= 0.0 ? 0.0 : from >= wide ? 1.0 : from / wide;
}

/// Place of a surfel along one axis, found in the world, so that it is the same for all grids of a
/// cell's size. All light of a cell at the end of a grid stays in it. Nodes outside take their
/// share of blockers.
/// @return false outside of the grid
static bool find_along(const alpi_lpv_injection *in, uint32_t i, uint32_t axis,
                       alpi_lpv_place *place)
{
    const double n = (double)in->surfels->normals[i][axis];
    const double position = (double)in->surfels->positions[i][axis] / in->grid->cell;
    const double corner = (double)in->grid->corner[axis], last = (double)in->ends[axis] - 1.0;
    // Nodes lie at corners of cells, virtual lights half a cell above their surfaces.
    const double at =
        position + (in->blockers ? ALP_LPV_BEYOND * n : (ALP_LPV_ABOVE + ALP_LPV_BEYOND) * n - 0.5);
    const double reach = in->blockers ? 1.0 : 0.5; // beyond the first and the last
    if (!(at - corner >= -reach && at - corner < last + reach)) {
        return false;
    }
    const int64_t toward_0 = (int64_t)at, below = toward_0 - ((double)toward_0 > at);
    const int64_t low = below - in->grid->corner[axis];
    place->low[axis] = (int16_t)low;
    place->part[axis] = (float)find_part(at - (double)below, n);
    if (!in->blockers && (low < 0 || low >= (int64_t)last)) {
        place->low[axis] = (int16_t)(low < 0 ? 0 : low);
        place->part[axis] = 0.0f;
    }
    return true;
}

/// Whether the grid holds surfel i, and where.
static bool find_place(const alpi_lpv_injection *in, uint32_t i, alpi_lpv_place *place)
{
    const float radius = in->surfels->radii != NULL ? in->surfels->radii[i] : 0.0f;
    const bool small = radius > 0.0f && 2.0 * (double)radius < in->grid->cell;
    if (small || !find_along(in, i, 0, place) || !find_along(in, i, 1, place) ||
        !find_along(in, i, 2, place)) {
        return false;
    }
    if (in->fades.count > 1 && !in->blockers) {
        place->share = (float)find_weight(in, in->surfels->positions[i]);
    }
    return place->share > 0.0f;
}

static alp_result find_places(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_lpv_injection *in = user;
    for (uint32_t i = begin; i < end; i++) {
        alpi_lpv_place *place = &in->lpv->places[i];
        place->held = place->usable && find_place(in, i, place);
        place->lights |= place->held && has_flux(in, i);
    }
    return ALP_OK;
}

/// Sorts surfels by their lower layer, from −1 on, and else by their index.
static void sort_by_layer(alpi_lpv_injection *in)
{
    const alp_lpv *lpv = in->lpv;
    uint32_t *const first = in->layers;
    memset(in->layers, 0, sizeof in->layers);
    for (uint32_t i = 0; i < in->surfels->count; i++) {
        if (lpv->places[i].held) {
            first[lpv->places[i].low[2] + 3]++;
        }
    }
    for (uint32_t z = 1; z < ALPI_LPV_LAYERS_MOST; z++) {
        first[z] += first[z - 1];
    }
    for (uint32_t i = 0; i < in->surfels->count; i++) {
        if (lpv->places[i].held) {
            lpv->order[first[lpv->places[i].low[2] + 2]++] = i;
        }
    }
}

// --- all of them ---------------------------------------------------------------------------------

static alp_result find_usable(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_lpv_injection *in = user;
    for (uint32_t i = begin; i < end; i++) {
        in->lpv->places[i] = (alpi_lpv_place){.share = 1.0f, .usable = is_usable(in, i)};
    }
    return ALP_OK;
}

alp_result alpi_lpv_begin_places(alpi_lpv_injection *in)
{
    alp_lpv *lpv = in->lpv;
    const uint32_t count = in->surfels->count;
    if (count > lpv->place_limit) {
        ALP_TRY(alpi_grow(lpv->context, (void **)&lpv->places, &lpv->place_limit, count,
                          sizeof *lpv->places));
    }
    if (count > lpv->order_limit) {
        ALP_TRY(alpi_grow(lpv->context, (void **)&lpv->order, &lpv->order_limit, count,
                          sizeof *lpv->order));
    }
    in->fades = alpi_lpv_find_fades(lpv, ALP_LPV_INJECTION_BORDER);
    ALP_TRY(alpi_parallel_for(lpv->context, count, GRAIN, find_usable, in, NULL));
    for (uint32_t i = 0; i < count; i++) {
        lpv->skipped += !lpv->places[i].usable;
        lpv->lit += lpv->places[i].usable && has_flux(in, i);
    }
    return ALP_OK;
}

void alpi_lpv_count_lights(const alpi_lpv_injection *in)
{
    for (uint32_t i = 0; i < in->surfels->count; i++) {
        in->lpv->lights += in->lpv->places[i].lights;
    }
}

alp_result alpi_lpv_find_places(alpi_lpv_injection *in, uint32_t index)
{
    in->index = index;
    in->grid = &in->lpv->grids[index];
    for (int k = 0; k < 3; k++) {
        in->ends[k] = in->grid->size[k] + (in->blockers ? 1 : 0);
    }
    ALP_TRY(alpi_parallel_for(in->lpv->context, in->surfels->count, GRAIN, find_places, in, NULL));
    sort_by_layer(in);
    return ALP_OK;
}
