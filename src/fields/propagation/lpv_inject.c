// SPDX-License-Identifier: MIT
// Surfels into grids: light into cells, blockers into nodes. Each worker takes layers of the grid
// and adds the surfels there in their order, so that sums do not depend on the number of workers.
#include "base/tasks.h"
#include "fields/propagation/lpv_places.h"

#include <math.h>
#include <string.h>

// --- adding --------------------------------------------------------------------------------------

/// A cosine lobe of flux Φ about n: Φ/π (1/4 + n·ω/2).
static void make_lobe(float flux_over_pi, const float n[3], float lobe[ALPI_LPV_TERMS])
{
    lobe[0] = 0.25f * flux_over_pi;
    for (int k = 0; k < 3; k++) {
        lobe[1 + k] = 0.5f * flux_over_pi * n[k];
    }
}

static void make_light(const alpi_lpv_injection *in, uint32_t i, float terms[ALPI_LPV_ROWS])
{
    for (size_t channel = 0; channel < 3; channel++) {
        make_lobe(in->surfels->flux[i][channel] / (float)ALPI_PI, in->surfels->normals[i],
                  terms + channel * ALPI_LPV_TERMS);
    }
}

/// B(ω) = A/s² (1/4 + n·ω/2): the lobe of a "flux" of π A/s². Then albedo × opacity.
static void make_blocker(const alpi_lpv_injection *in, uint32_t i, float terms[ALPI_LPV_ROWS])
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

/// Sums of surfels that lie between the same four places of a layer. They are next to each other in
/// a map, and a sum in one place is faster than sums in four.
typedef struct run {
    int16_t low[2];
    float sums[4][ALPI_LPV_ROWS]; // x, y: 00, 10, 01, 11
} run;

static void add_to_cell(const alpi_lpv_grid *g, const uint32_t at[3], const float *terms)
{
    const size_t n = g->size[0], row = (size_t)at[2] * g->size[1] + at[1];
    float *rows = g->injected + row * ALPI_LPV_ROWS * n + at[0];
    for (size_t t = 0; t < ALPI_LPV_ROWS; t++) {
        rows[t * n] += terms[t];
    }
}

static void add_to_node(const alpi_lpv_grid *g, const uint32_t at[3], const float *terms)
{
    const size_t wide = g->size[0] + 1, row = (size_t)at[2] * (g->size[1] + 1) + at[1];
    float *node = g->view + (row * wide + at[0]) * ALPI_LPV_NODE_TERMS;
    for (size_t t = 0; t < ALPI_LPV_NODE_TERMS; t++) {
        node[t] += terms[t];
    }
}

static void end_run(const alpi_lpv_injection *in, uint32_t z, run *r)
{
    for (int c = 0; c < 4; c++) { // a place one below the first is beyond the last, too
        const uint32_t at[3] = {(uint32_t)(r->low[0] + (c & 1)), (uint32_t)(r->low[1] + (c >> 1)),
                                z};
        if (at[0] < in->ends[0] && at[1] < in->ends[1]) {
            (in->blockers ? add_to_node : add_to_cell)(in->grid, at, r->sums[c]);
        }
    }
    memset(r->sums, 0, sizeof r->sums);
}

/// Adds a surfel to the layer below or above it.
static void add_surfel(const alpi_lpv_injection *in, uint32_t i, bool above, run *r)
{
    const alpi_lpv_place *p = &in->lpv->places[i];
    const float share = p->share * (above ? p->part[2] : 1.0f - p->part[2]);
    const float x = p->part[0], y = p->part[1],
                parts[4] = {(1.0f - x) * (1.0f - y), x * (1.0f - y), (1.0f - x) * y, x * y};
    float terms[ALPI_LPV_ROWS] = {0.0f};
    if (in->blockers) {
        make_blocker(in, i, terms);
    } else {
        make_light(in, i, terms);
    }
    for (int c = 0; c < 4; c++) {
        for (int t = 0; t < ALPI_LPV_ROWS; t++) {
            r->sums[c][t] += share * parts[c] * terms[t];
        }
    }
}

/// The surfels below layer z, then those above it.
static alp_result add_layers(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_lpv_injection *in = user;
    for (uint32_t z = begin; z < end; z++) {
        const uint32_t *first = in->layers + z;
        run r = {.low = {0, 0}};
        for (uint32_t k = first[0]; k < first[2]; k++) {
            const uint32_t i = in->lpv->order[k];
            const alpi_lpv_place *p = &in->lpv->places[i];
            if (p->low[0] != r.low[0] || p->low[1] != r.low[1]) {
                end_run(in, z, &r);
                memcpy(r.low, p->low, sizeof r.low);
            }
            add_surfel(in, i, k < first[1], &r);
        }
        end_run(in, z, &r);
    }
    return ALP_OK;
}

/// Into grids [first, end).
static alp_result inject(alpi_lpv_injection *in, uint32_t first, uint32_t end)
{
    ALP_TRY(alpi_lpv_begin_places(in));
    for (uint32_t c = first; c < end; c++) {
        ALP_TRY(alpi_lpv_find_places(in, c));
        ALP_TRY(alpi_parallel_for(in->lpv->context, in->ends[2], 1, add_layers, in, NULL));
    }
    alpi_lpv_count_lights(in);
    return ALP_OK;
}

// --- the host's calls ----------------------------------------------------------------------------

static alp_result check_cascade(const alp_lpv *lpv, uint32_t cascade, const char *what)
{
    if (cascade != ALP_LPV_ALL_CASCADES && cascade >= lpv->options.cascades) {
        return alpi_fail(lpv->context, ALP_ERROR_INVALID_ARGUMENT,
                         "lpv: %s for cascade %u of %u; they are numbered from 0", what, cascade,
                         lpv->options.cascades);
    }
    return ALP_OK;
}

/// @param needed array beside positions and normals that must be there, by its name
static alp_result check_surfels(const alp_lpv *lpv, const alp_lpv_surfels *s, const char *what,
                                const void *needed, const char *name)
{
    const char *missing = s->positions == NULL ? "positions"
                          : s->normals == NULL ? "normals"
                          : needed == NULL     ? name
                                               : NULL;
    if (s->count > 0 && missing != NULL) {
        return alpi_fail(lpv->context, ALP_ERROR_INVALID_ARGUMENT, "lpv: %s without %s", what,
                         missing);
    }
    return ALP_OK;
}

alp_result alp_lpv_add_light(alp_lpv *lpv, uint32_t cascade, const alp_lpv_surfels *surfels)
{
    ALP_TRY(check_cascade(lpv, cascade, "light"));
    ALP_TRY(check_surfels(lpv, surfels, "light", surfels->flux, "flux"));
    alpi_lpv_injection in = {.lpv = lpv, .surfels = surfels, .cascade = cascade};
    return inject(&in, cascade == ALP_LPV_ALL_CASCADES ? 0 : cascade, lpv->options.cascades);
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

alp_result alp_lpv_add_blockers(alp_lpv *lpv, uint32_t cascade, const alp_lpv_surfels *surfels)
{
    const bool all = cascade == ALP_LPV_ALL_CASCADES;
    if (!lpv->options.blockers) {
        return alpi_fail(lpv->context, ALP_ERROR_INVALID_ARGUMENT,
                         "lpv: the volume was made without blockers");
    }
    ALP_TRY(check_cascade(lpv, cascade, "blockers"));
    ALP_TRY(check_surfels(lpv, surfels, "blockers", surfels->areas, "areas"));
    alpi_lpv_injection in = {.lpv = lpv, .surfels = surfels, .cascade = cascade, .blockers = true};
    const uint32_t first = all ? 0 : cascade, end = all ? lpv->options.cascades : cascade + 1;
    ALP_TRY(inject(&in, first, end));
    for (uint32_t c = first; c < end; c++) {
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
    lpv->skipped = lpv->lit = lpv->lights = 0;
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
