// SPDX-License-Identifier: MIT
// Surfels into grids: light into cells, blockers into nodes. Places are found first. Then each
// worker takes layers of the grid and adds the surfels there in their order, so that sums do not
// depend on the number of workers.
#include "base/memory.h"
#include "base/tasks.h"
#include "fields/propagation/lpv.h"

#include <math.h>
#include <string.h>

enum { GRAIN = 4096, LAYERS_MOST = ALPI_LPV_SIDE_MOST + 4 };
static const float UNUSABLE = -1.0f; // in place of a share
/// A virtual light lies half a cell above its surface. Surfaces often lie between two cells, and
/// there rounding would choose: a thousandth more makes the choice.
static const double ABOVE = 0.5, BEYOND = 0.001;
/// Share of half a grid in which light fades that is injected: all of it where the grid moves on.
static const double BORDER = 0.15;

typedef struct injection {
    alp_lpv *lpv;
    const alp_lpv_surfels *surfels;
    alpi_lpv_grid *grid;
    uint32_t ends[3]; // cells or nodes of the grid
    uint32_t index;   // of the grid
    uint32_t cascade; // whose map the surfels are, or ALP_LPV_ALL_CASCADES
    bool blockers;
    alpi_lpv_fades fades;
    uint32_t layers[LAYERS_MOST]; // first surfel in `order` whose lower layer is index − 1
} injection;

// --- what is usable ------------------------------------------------------------------------------

static bool is_good(const float v[3], float least)
{
    bool good = true;
    for (int k = 0; k < 3; k++) {
        good = good && isfinite(v[k]) && v[k] >= least;
    }
    return good;
}

static bool is_usable(const injection *in, uint32_t i)
{
    const alp_lpv_surfels *s = in->surfels;
    const float *n = s->normals[i], anything = -HUGE_VALF;
    const float squares = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    bool good = is_good(s->positions[i], anything) && squares > 0.98f && squares < 1.02f;
    if (in->blockers) {
        good = good && isfinite(s->areas[i]) && s->areas[i] >= 0.0f;
        good = good && (s->albedo == NULL || is_good(s->albedo[i], 0.0f));
    } else {
        good = good && is_good(s->flux[i], 0.0f);
    }
    return good && (s->radii == NULL || isfinite(s->radii[i]));
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
static double find_weight(const injection *in, const float position[3])
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
static bool find_along(const injection *in, uint32_t i, uint32_t axis, alpi_lpv_place *place)
{
    const double n = (double)in->surfels->normals[i][axis];
    const double position = (double)in->surfels->positions[i][axis] / in->grid->cell;
    const double corner = (double)in->grid->corner[axis], last = (double)in->ends[axis] - 1.0;
    // Nodes lie at corners of cells, virtual lights half a cell above their surfaces.
    const double at = position + (in->blockers ? BEYOND * n : (ABOVE + BEYOND) * n - 0.5);
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

static alpi_lpv_place find_place(const injection *in, uint32_t i)
{
    const alp_lpv_surfels *s = in->surfels;
    alpi_lpv_place place = {.share = UNUSABLE};
    if (!is_usable(in, i)) {
        return place;
    }
    const float radius = s->radii != NULL ? s->radii[i] : 0.0f;
    const bool small = radius > 0.0f && 2.0 * (double)radius < in->grid->cell;
    place.share = 0.0f;
    if (!small && find_along(in, i, 0, &place) && find_along(in, i, 1, &place) &&
        find_along(in, i, 2, &place)) {
        const bool whole = in->blockers || in->fades.count == 1;
        place.share = whole ? 1.0f : (float)find_weight(in, s->positions[i]);
    }
    return place;
}

static alp_result find_places(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const injection *in = user;
    for (uint32_t i = begin; i < end; i++) {
        in->lpv->places[i] = find_place(in, i);
    }
    return ALP_OK;
}

// --- adding --------------------------------------------------------------------------------------

/// A cosine lobe of flux Φ about n: Φ/π (1/4 + n·ω/2).
static void make_lobe(float flux_over_pi, const float n[3], float lobe[ALPI_LPV_TERMS])
{
    lobe[0] = 0.25f * flux_over_pi;
    for (int k = 0; k < 3; k++) {
        lobe[1 + k] = 0.5f * flux_over_pi * n[k];
    }
}

static void add_light(const alpi_lpv_grid *g, const uint32_t cell[3], float share,
                      const float terms[ALPI_LPV_ROWS])
{
    const size_t n = g->size[0], row = (size_t)cell[2] * g->size[1] + cell[1];
    float *rows = g->injected + row * ALPI_LPV_ROWS * n + cell[0];
    for (size_t t = 0; t < ALPI_LPV_ROWS; t++) {
        rows[t * n] += share * terms[t];
    }
}

static void add_blocker(const alpi_lpv_grid *g, const uint32_t cell[3], float share,
                        const float terms[ALPI_LPV_ROWS])
{
    const size_t wide = g->size[0] + 1, row = (size_t)cell[2] * (g->size[1] + 1) + cell[1];
    float *node = g->view + (row * wide + cell[0]) * ALPI_LPV_NODE_TERMS;
    for (size_t t = 0; t < ALPI_LPV_NODE_TERMS; t++) {
        node[t] += share * terms[t];
    }
}

static void make_light(const injection *in, uint32_t i, float terms[ALPI_LPV_ROWS])
{
    for (size_t channel = 0; channel < 3; channel++) {
        make_lobe(in->surfels->flux[i][channel] / (float)ALPI_PI, in->surfels->normals[i],
                  terms + channel * ALPI_LPV_TERMS);
    }
}

/// B(ω) = A/s² (1/4 + n·ω/2): the lobe of a "flux" of π A/s². Then albedo × opacity.
static void make_blocker(const injection *in, uint32_t i, float terms[ALPI_LPV_ROWS])
{
    static const float grey[3] = {0.5f, 0.5f, 0.5f};
    const alp_lpv_surfels *s = in->surfels;
    const float *albedo = s->albedo != NULL ? s->albedo[i] : grey;
    const float share = (float)((double)s->areas[i] / (in->grid->cell * in->grid->cell));
    make_lobe(share, s->normals[i], terms);
    for (int k = 0; k < 3; k++) {
        terms[ALPI_LPV_TERMS + k] = 0.25f * share * albedo[k];
    }
}

/// Adds surfel i to the cells round its place in one layer, the lower or the upper one.
static void add_surfel(const injection *in, uint32_t i, bool upper)
{
    const alpi_lpv_place *place = &in->lpv->places[i];
    const float share = place->share * (upper ? place->part[2] : 1.0f - place->part[2]);
    float terms[ALPI_LPV_ROWS];
    if (share <= 0.0f) {
        return;
    }
    if (in->blockers) {
        make_blocker(in, i, terms);
    } else {
        make_light(in, i, terms);
    }
    for (int c = 0; c < 4; c++) {
        const int x = c & 1, y = c >> 1;
        const uint32_t cell[3] = {(uint32_t)(place->low[0] + x), (uint32_t)(place->low[1] + y),
                                  (uint32_t)(place->low[2] + upper)};
        const float part = (x != 0 ? place->part[0] : 1.0f - place->part[0]) *
                           (y != 0 ? place->part[1] : 1.0f - place->part[1]);
        // One below the first is beyond the last, too.
        if (part > 0.0f && cell[0] < in->ends[0] && cell[1] < in->ends[1]) {
            (in->blockers ? add_blocker : add_light)(in->grid, cell, share * part, terms);
        }
    }
}

static alp_result add_layers(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const injection *in = user;
    for (uint32_t z = begin; z < end; z++) {
        const uint32_t *first = in->layers + z; // of those between layers z − 1 and z, z and z + 1
        for (uint32_t k = first[0]; k < first[2]; k++) {
            add_surfel(in, in->lpv->order[k], k < first[1]);
        }
    }
    return ALP_OK;
}

/// Sorts surfels by their lower layer, from −1 on, and else by their index.
static void sort_by_layer(injection *in)
{
    const alp_lpv *lpv = in->lpv;
    uint32_t *const first = in->layers;
    memset(in->layers, 0, sizeof in->layers);
    for (uint32_t i = 0; i < in->surfels->count; i++) {
        first[lpv->places[i].low[2] + 3] += lpv->places[i].share > 0.0f;
    }
    for (uint32_t z = 1; z < LAYERS_MOST; z++) {
        first[z] += first[z - 1];
    }
    for (uint32_t i = 0; i < in->surfels->count; i++) {
        if (lpv->places[i].share > 0.0f) {
            lpv->order[first[lpv->places[i].low[2] + 2]++] = i;
        }
    }
}

static void count_unusable(const injection *in)
{
    for (uint32_t i = 0; i < in->surfels->count; i++) {
        in->lpv->skipped += in->lpv->places[i].share == UNUSABLE;
    }
}

static alp_result inject(injection *in)
{
    alp_lpv *lpv = in->lpv;
    const uint32_t count = in->surfels->count, finest = in->index;
    in->fades = alpi_lpv_find_fades(lpv, BORDER);
    if (count > lpv->place_limit) {
        ALP_TRY(alpi_grow(lpv->context, (void **)&lpv->places, &lpv->place_limit, count,
                          sizeof *lpv->places));
    }
    if (count > lpv->order_limit) {
        ALP_TRY(alpi_grow(lpv->context, (void **)&lpv->order, &lpv->order_limit, count,
                          sizeof *lpv->order));
    }
    for (; in->index < lpv->options.cascades; in->index++) {
        in->grid = &lpv->grids[in->index];
        for (int k = 0; k < 3; k++) {
            in->ends[k] = in->grid->size[k] + (in->blockers ? 1 : 0);
        }
        ALP_TRY(alpi_parallel_for(lpv->context, count, GRAIN, find_places, in, NULL));
        sort_by_layer(in);
        ALP_TRY(alpi_parallel_for(lpv->context, in->ends[2], 1, add_layers, in, NULL));
        if (in->index == finest) {
            count_unusable(in);
        }
    }
    return ALP_OK;
}

// --- the host's calls ----------------------------------------------------------------------------

alp_result alp_lpv_add_light(alp_lpv *lpv, uint32_t cascade, const alp_lpv_surfels *surfels)
{
    const bool all = cascade == ALP_LPV_ALL_CASCADES;
    if (!all && cascade >= lpv->options.cascades) {
        return alpi_fail(lpv->context, ALP_ERROR_INVALID_ARGUMENT,
                         "lpv: light for cascade %u of %u; they are numbered from 0", cascade,
                         lpv->options.cascades);
    }
    if (surfels->count > 0 && surfels->flux == NULL) {
        return alpi_fail(lpv->context, ALP_ERROR_INVALID_ARGUMENT, "lpv: light without flux");
    }
    injection in = {.lpv = lpv, .surfels = surfels, .index = all ? 0 : cascade, .cascade = cascade};
    return inject(&in);
}

/// Adds a view to the merged ones: views show the same surfaces. A view without surface at a node
/// does not count there. CONFORMANCE: the maximum of each term, as the paper does. Else the view
/// with more surface has the node.
static void merge_view(alpi_lpv_grid *g, bool by_term)
{
    enum { N = ALPI_LPV_NODE_TERMS };
    const size_t nodes = alpi_lpv_nodes(g->size);
    for (size_t i = 0; i < nodes; i++) {
        float *into = g->nodes + i * N, *from = g->view + i * N;
        const bool both = into[0] > 0.0f && from[0] > 0.0f;
        if (by_term && both) {
            for (int t = 0; t < N; t++) {
                into[t] = fmaxf(into[t], from[t]);
            }
        } else if (from[0] > into[0]) {
            memcpy(into, from, N * sizeof *into);
        }
    }
    memset(g->view, 0, nodes * N * sizeof *g->view);
}

alp_result alp_lpv_add_blockers(alp_lpv *lpv, const alp_lpv_surfels *surfels)
{
    if (!lpv->options.blockers) {
        return alpi_fail(lpv->context, ALP_ERROR_INVALID_ARGUMENT,
                         "lpv: the volume was made without blockers");
    }
    if (surfels->count > 0 && surfels->areas == NULL) {
        return alpi_fail(lpv->context, ALP_ERROR_INVALID_ARGUMENT, "lpv: blockers without areas");
    }
    injection in = {
        .lpv = lpv, .surfels = surfels, .cascade = ALP_LPV_ALL_CASCADES, .blockers = true};
    ALP_TRY(inject(&in));
    for (uint32_t c = 0; c < lpv->options.cascades; c++) {
        merge_view(&lpv->grids[c], lpv->options.mode != ALP_LPV_ACCURATE);
    }
    return ALP_OK;
}

// --- frames --------------------------------------------------------------------------------------

/// Nodes to where the grid is now; those that are new are empty.
static void move_nodes(alpi_lpv_grid *g)
{
    enum { N = ALPI_LPV_NODE_TERMS };
    const int64_t n[3] = {(int64_t)g->size[0] + 1, (int64_t)g->size[1] + 1,
                          (int64_t)g->size[2] + 1};
    for (int64_t z = 0; z < n[2]; z++) {
        for (int64_t y = 0; y < n[1]; y++) {
            for (int64_t x = 0; x < n[0]; x++) {
                const int64_t at[3] = {x + g->corner[0] - g->node_corner[0],
                                       y + g->corner[1] - g->node_corner[1],
                                       z + g->corner[2] - g->node_corner[2]};
                bool held = true;
                for (int k = 0; k < 3; k++) {
                    held = held && at[k] >= 0 && at[k] < n[k];
                }
                if (held) {
                    memcpy(g->view + ((z * n[1] + y) * n[0] + x) * N,
                           g->nodes + ((at[2] * n[1] + at[1]) * n[0] + at[0]) * N,
                           N * sizeof *g->view);
                }
            }
        }
    }
    float *swap = g->nodes;
    g->nodes = g->view;
    g->view = swap;
    memset(g->view, 0, alpi_lpv_nodes(g->size) * N * sizeof *g->view);
}

static void begin(alp_lpv *lpv, bool keep)
{
    lpv->skipped = 0;
    for (uint32_t c = 0; c < lpv->options.cascades; c++) {
        alpi_lpv_grid *g = &lpv->grids[c];
        memset(g->injected, 0, ALPI_LPV_ROWS * alpi_lpv_cells(g->size) * sizeof *g->injected);
        if (g->nodes != NULL && !keep) {
            memset(g->nodes, 0, ALPI_LPV_NODE_TERMS * alpi_lpv_nodes(g->size) * sizeof *g->nodes);
        } else if (g->nodes != NULL && memcmp(g->corner, g->node_corner, sizeof g->corner) != 0) {
            move_nodes(g);
        }
        memcpy(g->node_corner, g->corner, sizeof g->corner);
    }
}

void alp_lpv_begin(alp_lpv *lpv)
{
    begin(lpv, false);
}

void alp_lpv_begin_with_last_blockers(alp_lpv *lpv)
{
    begin(lpv, true);
}
