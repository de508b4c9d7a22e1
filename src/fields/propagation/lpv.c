// SPDX-License-Identifier: MIT
// The volume as a host sees it: its life, where its grids are, and the run of a frame.
#include "fields/propagation/lpv.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "base/vec.h"

#include <math.h>
#include <string.h>

enum { CASCADE_ITERATIONS = 8 };

// --- life ----------------------------------------------------------------------------------------

/// Readers find the sums where they were made, also after the grids have moved.
static void keep_corners(alp_lpv *lpv)
{
    for (uint32_t c = 0; c < lpv->options.cascades; c++) {
        memcpy(lpv->grids[c].sum_corner, lpv->grids[c].corner, sizeof lpv->grids[c].corner);
    }
}

static alp_result make_grid(alp_lpv *lpv, alpi_lpv_grid *g)
{
    alp_context *context = lpv->context;
    const size_t cells = alpi_lpv_cells(g->size), wide = alpi_lpv_wide_cells(g->size);
    ALPI_TRY_NEW(context, g->injected, ALPI_LPV_ROWS * cells);
    ALPI_TRY_NEW(context, g->sum, ALPI_LPV_ROWS * cells);
    ALPI_TRY_NEW(context, g->light, ALPI_LPV_ROWS * wide);
    ALPI_TRY_NEW(context, g->next, ALPI_LPV_ROWS * wide);
    if (lpv->options.blockers) {
        const size_t nodes = alpi_lpv_nodes(g->size);
        ALPI_TRY_NEW(context, g->faces, 3 * ALPI_LPV_AXIS_ROWS * nodes);
        ALPI_TRY_NEW(context, g->nodes, ALPI_LPV_NODE_TERMS * nodes);
        ALPI_TRY_NEW(context, g->view, ALPI_LPV_NODE_TERMS * nodes);
    }
    return ALP_OK;
}

alp_result alp_lpv_create(alp_context *context, const alp_lpv_options *options, alp_lpv **out)
{
    if (context == NULL || out == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *out = NULL;
    const alp_lpv_options o = options ? *options : alp_lpv_options_default();
    ALP_TRY(alpi_lpv_check_options(context, &o));
    alp_lpv *lpv = ALPI_NEW(context, alp_lpv, 1);
    if (lpv == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    lpv->context = context;
    lpv->options = o;
    const uint32_t *n = o.size;
    const uint32_t xy = n[0] > n[1] ? n[0] : n[1], longest = xy > n[2] ? xy : n[2];
    lpv->iterations = o.iterations > 0 ? o.iterations
                      : o.cascades > 1 ? CASCADE_ITERATIONS
                                       : longest;
    alp_result result = ALP_OK;
    for (uint32_t c = 0; c < o.cascades && result == ALP_OK; c++) {
        lpv->grids[c].cell = ldexp(o.cell, (int)c);
        memcpy(lpv->grids[c].size, n, sizeof lpv->grids[c].size);
        result = make_grid(lpv, &lpv->grids[c]);
    }
    if (result == ALP_OK) {
        const double nowhere[3] = {0.0, 0.0, 0.0};
        result = alp_lpv_follow(lpv, o.centre, nowhere);
        keep_corners(lpv);
    }
    if (result != ALP_OK) {
        alp_lpv_destroy(lpv);
        return result;
    }
    *out = lpv;
    return ALP_OK;
}

void alp_lpv_destroy(alp_lpv *lpv)
{
    if (lpv == NULL) {
        return;
    }
    for (uint32_t c = 0; c < lpv->options.cascades; c++) {
        const alpi_lpv_grid *g = &lpv->grids[c];
        float *const volumes[] = {g->injected, g->light, g->next, g->sum,
                                  g->faces,    g->nodes, g->view};
        for (size_t i = 0; i < sizeof volumes / sizeof *volumes; i++) {
            alpi_release(lpv->context, volumes[i]);
        }
    }
    alpi_release(lpv->context, lpv->places);
    alpi_release(lpv->context, lpv->order);
    alpi_release(lpv->context, lpv);
}

// --- where the grids are -------------------------------------------------------------------------

void alp_lpv_place(const alp_lpv_options *o, uint32_t cascade, const double eye[3],
                   const double forward[3], alp_lpv_placement *place)
{
    place->cell = ldexp(o->cell, (int)cascade);
    for (int k = 0; k < 3; k++) {
        const double half = 0.5 * place->cell * (double)o->size[k];
        place->centre[k] = eye[k] + ALP_LPV_AHEAD * half * forward[k];
        place->corner[k] =
            (int64_t)floor(place->centre[k] / place->cell - 0.5 * (double)o->size[k] + 0.5);
    }
}

void alpi_lpv_ideal_centre(const alp_lpv *lpv, uint32_t cascade, double centre[3])
{
    alp_lpv_placement place;
    alp_lpv_place(&lpv->options, cascade, lpv->eye, lpv->forward, &place);
    memcpy(centre, place.centre, sizeof place.centre);
}

alp_result alp_lpv_follow(alp_lpv *lpv, const double eye[3], const double forward[3])
{
    double most = 0.0, squares = 0.0;
    for (int k = 0; k < 3; k++) {
        if (!(fabs(eye[k]) <= ALPI_LPV_FARTHEST * lpv->options.cell)) {
            return alpi_fail(lpv->context, ALP_ERROR_INVALID_ARGUMENT,
                             "lpv: the eye at %g, %g, %g is beyond 2^40 cells", eye[0], eye[1],
                             eye[2]);
        }
        if (!isfinite(forward[k])) {
            return alpi_fail(lpv->context, ALP_ERROR_INVALID_ARGUMENT,
                             "lpv: the direction %g, %g, %g is not finite", forward[0], forward[1],
                             forward[2]);
        }
        most = fmax(most, fabs(forward[k]));
    }
    for (int k = 0; k < 3 && most > 0.0; k++) {
        squares += forward[k] / most * (forward[k] / most);
    }
    for (int k = 0; k < 3; k++) {
        lpv->eye[k] = eye[k];
        lpv->forward[k] = most > 0.0 ? forward[k] / most / sqrt(squares) : 0.0;
    }
    for (uint32_t c = 0; c < lpv->options.cascades; c++) {
        alp_lpv_placement place;
        alp_lpv_place(&lpv->options, c, lpv->eye, lpv->forward, &place);
        memcpy(lpv->grids[c].corner, place.corner, sizeof place.corner);
    }
    return ALP_OK;
}

// --- a frame -------------------------------------------------------------------------------------

/// Rows of all grids, for workers.
typedef struct row_loop {
    const alp_lpv *lpv;
    alpi_lpv_rows_fn *body;
    uint32_t rows; // of a grid
    alpi_lpv_step step;
} row_loop;

static alp_result run_rows(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const row_loop *loop = user;
    const alpi_lpv_grid *grids = loop->lpv->grids;
    while (begin < end) {
        const uint32_t first = begin % loop->rows, left = loop->rows - first;
        const uint32_t count = left < end - begin ? left : end - begin;
        loop->body(&grids[begin / loop->rows], &loop->step, first, first + count);
        begin += count;
    }
    return ALP_OK;
}

static alp_result run_loop(alp_lpv *lpv, alpi_lpv_rows_fn *body, uint32_t rows, row_loop *loop)
{
    enum { CELLS_A_TASK = 4096 };
    loop->body = body;
    loop->rows = rows;
    return alpi_parallel_for(lpv->context, rows * lpv->options.cascades,
                             CELLS_A_TASK / lpv->options.size[0] + 1, run_rows, loop, NULL);
}

alp_result alp_lpv_propagate(alp_lpv *lpv)
{
    const alpi_lpv_loops *loops = &ALPI_COMPILED_FOR(lpv->context, alpi_lpv_loops);
    const alp_lpv_options *o = &lpv->options;
    const uint32_t rows = o->size[1] * o->size[2];
    row_loop loop = {.lpv = lpv};
    loop.step.scheme = alpi_lpv_scheme_of(o->mode);
    loop.step.wraps = lpv->wraps;
    keep_corners(lpv);
    if (o->blockers) {
        ALP_TRY(run_loop(lpv, loops->faces, (o->size[1] + 1) * (o->size[2] + 1), &loop));
    }
    ALP_TRY(run_loop(lpv, loops->start, rows, &loop));
    for (uint32_t i = 0; i < lpv->iterations; i++) {
        // Blockers of the surface that light leaves would stop it in the first step.
        loop.step.blocked = o->blockers && i > 0;
        loop.step.reflects = loop.step.blocked && o->bounces != 1;
        ALP_TRY(run_loop(lpv, loops->step, rows, &loop));
        for (uint32_t c = 0; c < o->cascades; c++) {
            alpi_lpv_grid *g = &lpv->grids[c];
            float *swap = g->light;
            g->light = g->next;
            g->next = swap;
        }
    }
    return ALP_OK;
}

// --- what it holds -------------------------------------------------------------------------------

void alp_lpv_get_grid(const alp_lpv *lpv, uint32_t cascade, alp_lpv_grid *grid)
{
    const alpi_lpv_grid *g = &lpv->grids[cascade];
    *grid = (alp_lpv_grid){.cell = g->cell, .intensities = g->sum};
    for (int k = 0; k < 3; k++) {
        grid->size[k] = g->size[k];
        grid->corner[k] = (double)g->sum_corner[k] * g->cell;
    }
}

uint32_t alp_lpv_iterations(const alp_lpv *lpv)
{
    return lpv->iterations;
}

uint64_t alp_lpv_skipped(const alp_lpv *lpv)
{
    return lpv->skipped;
}
