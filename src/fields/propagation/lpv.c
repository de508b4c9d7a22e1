// SPDX-License-Identifier: MIT
// The volume as a host sees it: its life, where its grids are, and the run of a frame.
#include "fields/propagation/lpv.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "base/vec.h"

#include <math.h>
#include <string.h>

enum { ITERATIONS_MOST = 4096, CASCADE_ITERATIONS = 8 };
/// Cells from the origin that a grid may lie at: a double holds a thousandth of one there.
static const double FARTHEST = 1099511627776.0;
static const double CELL_LEAST = 1e-6, CELL_MOST = 1e12; // metres
/// Share of half a grid by which its centre lies ahead of the eye.
static const double AHEAD = 0.5;
/// Mean of the direction over the far face, and over a side face along the way and aside: the
/// integrals of direction over solid angle, divided by it.
static const float MEAN_FAR = 0.966914f, MEAN_ALONG = 0.799082f, MEAN_ASIDE = 0.518084f;

alpi_lpv_scheme alpi_lpv_scheme_of(alp_lpv_mode mode)
{
    const float along = (float)ALP_LPV_ALONG, aside = (float)ALP_LPV_ASIDE;
    switch (mode) {
    case ALP_LPV_CONFORMANCE:
        return (alpi_lpv_scheme){1.0f, along, aside, 0.0f, 1.0f, 1.0f, false};
    case ALP_LPV_TRANSFER:
        return (alpi_lpv_scheme){MEAN_FAR, MEAN_ALONG, MEAN_ASIDE, 0.0f, 1.0f, 1.0f, false};
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
    // The centre is rounded to cells, by half a cell at most: 3 cells make room on both sides.
    o.cell = grid > 3 ? longest / (double)(grid - 3) : longest;
    o.cell = o.cell > 0.0 ? ldexp(o.cell, 1 - (int)cascades) : 1.0;
    return o;
}

uint64_t alp_lpv_memory(const alp_lpv_options *o)
{
    const uint64_t cells = alpi_lpv_cells(o->size), nodes = alpi_lpv_nodes(o->size);
    const uint64_t light = 2 * ALPI_LPV_ROWS * (cells + alpi_lpv_wide_cells(o->size));
    const uint64_t blockers = (ALPI_LPV_OPEN_ROWS + 2 * ALPI_LPV_NODE_TERMS) * nodes;
    return o->cascades * sizeof(float) * (light + (o->blockers ? blockers : 0));
}

static alp_result check_options(alp_context *context, const alp_lpv_options *o)
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
        if (!isfinite(o->centre[k]) || fabs(o->centre[k]) > FARTHEST * o->cell) {
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
        ALPI_TRY_NEW(context, g->open, ALPI_LPV_OPEN_ROWS * nodes);
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
    ALP_TRY(check_options(context, &o));
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
                                  g->open,     g->nodes, g->view};
        for (size_t i = 0; i < sizeof volumes / sizeof *volumes; i++) {
            alpi_release(lpv->context, volumes[i]);
        }
    }
    alpi_release(lpv->context, lpv->places);
    alpi_release(lpv->context, lpv->order);
    alpi_release(lpv->context, lpv);
}

// --- where the grids are -------------------------------------------------------------------------

void alpi_lpv_ideal_centre(const alp_lpv *lpv, uint32_t cascade, double centre[3])
{
    const alpi_lpv_grid *g = &lpv->grids[cascade];
    for (int k = 0; k < 3; k++) {
        const double half = 0.5 * g->cell * (double)g->size[k];
        centre[k] = lpv->eye[k] + AHEAD * half * lpv->forward[k];
    }
}

alp_result alp_lpv_follow(alp_lpv *lpv, const double eye[3], const double forward[3])
{
    double most = 0.0, squares = 0.0;
    for (int k = 0; k < 3; k++) {
        if (!(fabs(eye[k]) <= FARTHEST * lpv->options.cell)) {
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
        alpi_lpv_grid *g = &lpv->grids[c];
        double centre[3];
        alpi_lpv_ideal_centre(lpv, c, centre);
        for (int k = 0; k < 3; k++) {
            g->corner[k] = (int64_t)floor(centre[k] / g->cell - 0.5 * (double)g->size[k] + 0.5);
        }
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
        ALP_TRY(run_loop(lpv, loops->open, (o->size[1] + 1) * (o->size[2] + 1), &loop));
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
