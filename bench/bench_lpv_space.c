// SPDX-License-Identifier: MIT
// Light propagation in spaces with known answers: the reach of one light, a wall of one cell, and a
// closed box that emits.
#include "lpv_parts.h"
#include "plot.h"

#include "fields/propagation/lpv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REACH = 16 };
static const char *const mode_names[ALP_LPV_MODE_COUNT] = {"accurate", "conformance", "transfer"};

// --- reach ---------------------------------------------------------------------------------------

/// E on the axis of one light over Φ/(πr²), at 1 … REACH cells.
static alp_result find_reach(alp_context *context, alp_lpv_mode mode, uint32_t steps,
                             float reach[REACH])
{
    const float position[1][3] = {{0.5f, 0.5f, 0.0f}}, up[1][3] = {{0.0f, 0.0f, 1.0f}};
    const float flux[1][3] = {{1.0f, 1.0f, 1.0f}};
    const alp_lpv_surfels light = {.count = 1, .positions = position, .normals = up, .flux = flux};
    alp_lpv_options o = alp_lpv_options_default();
    alp_lpv_grid g;
    alp_lpv *lpv = NULL;
    o.size[0] = o.size[1] = o.size[2] = 2 * REACH + 8;
    o.cell = 1.0;
    o.mode = mode;
    o.blockers = false;
    o.iterations = steps;
    ALP_TRY(alp_lpv_create(context, &o, &lpv));
    alp_lpv_begin(lpv);
    alp_result result = alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &light);
    result = result == ALP_OK ? alp_lpv_propagate(lpv) : result;
    alp_lpv_get_grid(lpv, 0, &g);
    const size_t n = g.size[0], zero = (size_t)(-g.corner[0]);
    for (size_t r = 1; r <= REACH && result == ALP_OK; r++) {
        const float *row = g.intensities + ((zero + r) * n + zero) * ALPI_LPV_ROWS * n + zero;
        const double e =
            (ALPI_PI * (double)row[0] + 2.0 / 3.0 * ALPI_PI * (double)row[3 * n]) / ALP_LPV_GAIN;
        reach[r - 1] = (float)(e * ALPI_PI * (double)(r * r));
    }
    alp_lpv_destroy(lpv);
    return result;
}

alp_result lpv_measure_reach(const bench_options *options)
{
    bench_scene none = {.name = "reach"};
    bench_table table;
    static float reach[ALP_LPV_MODE_COUNT][REACH];
    plot_panel panel = {.title = "E on the axis of a light over that of free space, 32 steps",
                        .across = "cells from the light",
                        .low = 1.0,
                        .high = REACH};
    bench_table_start(&table, "Reach",
                      "E on the axis of one light in free space over Φ/(πr²), after 32 steps. 1 "
                      "would be right.",
                      "mode|1 cell|2|3|4|6|8|12|16");
    alp_context_options o = alp_context_options_default();
    ALP_TRY(alp_context_create(&o, &none.context));
    alp_result result = ALP_OK;
    for (int m = 0; m < ALP_LPV_MODE_COUNT && result == ALP_OK; m++) {
        result = find_reach(none.context, (alp_lpv_mode)m, options->quick ? 2 : 32, reach[m]);
        const float *e = reach[m];
        bench_table_add(&table, "%s|%.3f|%.3f|%.3f|%.3f|%.3f|%.3f|%.3f|%.3f", mode_names[m],
                        (double)e[0], (double)e[1], (double)e[2], (double)e[3], (double)e[5],
                        (double)e[7], (double)e[11], (double)e[15]);
        panel.lines[m] = (plot_line){.name = mode_names[m], .values = e, .count = REACH};
    }
    panel.line_count = ALP_LPV_MODE_COUNT;
    (void)bench_good(&none, result);
    alp_context_destroy(none.context);
    bench_table_print(&table, options);
    if (result == ALP_OK && options->pictures != NULL) {
        char path[1024];
        snprintf(path, sizeof path, "%s/lpv-reach.svg", options->pictures);
        result = plot_write(path, "Reach of propagated light", &panel, 1) ? ALP_OK : ALP_ERROR_IO;
    }
    return result;
}

// --- volumes of one room -------------------------------------------------------------------------

static alp_result open_room(alp_context *context, alp_lpv_mode mode, uint32_t side, uint32_t steps,
                            bool blockers, alp_lpv **lpv)
{
    alp_lpv_options o = alp_lpv_options_default();
    o.size[0] = o.size[1] = o.size[2] = side;
    o.cell = 1.0;
    o.mode = mode;
    o.blockers = blockers;
    o.iterations = steps;
    ALP_TRY(alp_lpv_create(context, &o, lpv));
    alp_lpv_begin(*lpv);
    return ALP_OK;
}

/// `dense` × `dense` surfels a cell on the square [−half, half]² of a plane across an axis, and of
/// a second plane a cell behind it that faces the other way. All are turned about z.
typedef struct square {
    int axis;
    float at, side, half; // metres; the normal's sign
    int dense, planes;
    double angle;
} square;

/// Adds surfels as light, or as blockers where flux is 0. @param flux of each cell's face
static alp_result add_square(alp_lpv *lpv, const square *q, float flux)
{
    const int axis = q->axis, dense = q->dense, planes = q->planes;
    const float half = q->half;
    const int n = (int)lround(2.0 * (double)half * dense);
    const uint32_t count = (uint32_t)(n * n * planes);
    const float c = (float)cos(q->angle), s = (float)sin(q->angle),
                part = 1.0f / (float)(dense * dense);
    float(*positions)[3] = bench_allocate(count, sizeof *positions);
    float(*normals)[3] = bench_allocate(count, sizeof *normals);
    float(*fluxes)[3] = bench_allocate(count, sizeof *fluxes);
    float *areas = bench_allocate(count, sizeof *areas);
    for (int i = 0; i < n * n * planes; i++) {
        const int plane = i / (n * n), row = i / n % n;
        float p[3], w[3] = {0.0f, 0.0f, 0.0f};
        p[axis] = q->at + (float)plane;
        w[axis] = plane == 0 ? q->side : -q->side;
        p[(axis + 1) % 3] = ((float)(i % n) + 0.5f) / (float)dense - half;
        p[(axis + 2) % 3] = ((float)row + 0.5f) / (float)dense - half;
        const float turned[2][3] = {{c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]},
                                    {c * w[0] - s * w[1], s * w[0] + c * w[1], w[2]}};
        memcpy(positions[i], turned[0], sizeof turned[0]);
        memcpy(normals[i], turned[1], sizeof turned[1]);
        fluxes[i][0] = fluxes[i][1] = fluxes[i][2] = part * flux;
        areas[i] = part;
    }
    const alp_lpv_surfels surfels = {.count = count,
                                     .positions = (const float(*)[3])positions,
                                     .normals = (const float(*)[3])normals,
                                     .flux = (const float(*)[3])fluxes,
                                     .areas = areas};
    const alp_result result = flux > 0.0f
                                  ? alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &surfels)
                                  : alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &surfels);
    free(positions);
    free(normals);
    free(fluxes);
    free(areas);
    return result;
}

// --- walls ---------------------------------------------------------------------------------------

/// Mean E at 16 × 16 places of a turned plane, of light from the left.
static double mean_of_plane(const alp_field *field, double distance, double angle)
{
    const float c = (float)cos(angle), s = (float)sin(angle), x = (float)distance;
    float p[256][3], n[256][3], e[256][3];
    double sum = 0.0;
    for (int i = 0; i < 256; i++) {
        const int column = i % 16, row = i / 16;
        const float y = 4.0f * ((float)column / 7.5f - 1.0f);
        const float at[3] = {c * x - s * y, s * x + c * y, 4.0f * ((float)row / 7.5f - 1.0f)};
        const float normal[3] = {-c, -s, 0.0f};
        memcpy(p[i], at, sizeof at);
        memcpy(n[i], normal, sizeof normal);
    }
    alp_field_irradiance(field, 256, (const float(*)[3])p, (const float(*)[3])n, e);
    for (int i = 0; i < 256; i++) {
        sum += (double)e[i][0] / 256.0;
    }
    return sum;
}

/// E a cell behind a wall of one cell over E a cell before it, in %. Light comes from the left
/// border of a grid of 16³. @param at of the wall's left face, in cells
static alp_result find_leak(alp_context *context, alp_lpv_mode mode, float at, double angle,
                            double *leak)
{
    alp_lpv *lpv = NULL;
    alp_field *field = NULL;
    alp_result result = open_room(context, mode, 16, 32, true, &lpv);
    if (result == ALP_OK) {
        const square lamp = {0, -8.0f, 1.0f, 8.0f, 1, 1, 0.0};
        result = add_square(lpv, &lamp, 1.0f);
    }
    if (result == ALP_OK) {
        const square wall = {0, at, -1.0f, 12.0f, 8, 2, angle};
        result = add_square(lpv, &wall, 0.0f);
    }
    if (result == ALP_OK) {
        result = alp_lpv_propagate(lpv);
    }
    if (result == ALP_OK) {
        result = alp_field_create_lpv(lpv, &field);
    }
    if (result == ALP_OK) {
        *leak = 100.0 * mean_of_plane(field, (double)at + 2.0, angle) /
                mean_of_plane(field, (double)at - 1.0, angle);
    }
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
    return result;
}

alp_result lpv_measure_walls(const bench_options *options, lpv_figures *figures)
{
    enum { ANGLES = 3 };
    static const double angles[ANGLES] = {0.0, 0.4, 0.785398};
    const int places = options->quick ? 1 : 4, modes = options->quick ? 1 : ALP_LPV_MODE_COUNT;
    bench_scene none = {.name = "wall"};
    bench_table table;
    bench_table_start(
        &table, "A wall of one cell",
        "E a cell behind a wall over E a cell before it, in %, wherever its faces lie "
        "between cells: the worst of four places. By the wall's angle to the axes.",
        "mode|0 rad|0.4 rad|0.79 rad");
    alp_context_options o = alp_context_options_default();
    ALP_TRY(alp_context_create(&o, &none.context));
    alp_result result = ALP_OK;
    for (int m = 0; m < modes; m++) {
        double worst[ANGLES] = {0.0, 0.0, 0.0};
        for (int i = 0; i < ANGLES * places && result == ALP_OK; i++) {
            double leak = 0.0;
            const int place = i / ANGLES;
            result = find_leak(none.context, (alp_lpv_mode)m, 0.25f * (float)place,
                               angles[i % ANGLES], &leak);
            worst[i % ANGLES] = fmax(worst[i % ANGLES], leak);
        }
        if (m == ALP_LPV_ACCURATE) {
            figures->wall = fmax(worst[0], fmax(worst[1], worst[2]));
        }
        bench_table_add(&table, "%s|%.2f|%.2f|%.2f", mode_names[m], worst[0], worst[1], worst[2]);
    }
    (void)bench_good(&none, result);
    alp_context_destroy(none.context);
    bench_table_print(&table, options);
    return result;
}

// --- the closed box that emits -------------------------------------------------------------------

/// E at the centre of a box of side³ cells whose walls emit, over its true value.
static alp_result find_centre(alp_context *context, alp_lpv_mode mode, uint32_t side,
                              uint32_t steps, double *share)
{
    alp_lpv *lpv = NULL;
    alp_result result = open_room(context, mode, side, steps, false, &lpv);
    const float half = 0.5f * (float)side, pi = (float)ALPI_PI;
    for (int d = 0; d < 6 && result == ALP_OK; d++) {
        const float way = d % 2 == 0 ? 1.0f : -1.0f;
        const square side_of_box = {d / 2, way * half, -way, half, 1, 1, 0.0};
        result = add_square(lpv, &side_of_box, pi);
    }
    if (result == ALP_OK) {
        result = alp_lpv_propagate(lpv);
    }
    if (result == ALP_OK) {
        const alpi_lpv_grid *g = &lpv->grids[0];
        const size_t n = side, at = ((n / 2 * n + n / 2) * ALPI_LPV_ROWS) * n + n / 2;
        *share = (double)g->sum[at] / ALP_LPV_GAIN;
    }
    alp_lpv_destroy(lpv);
    return result;
}

alp_result lpv_measure_boxes(const bench_options *options)
{
    static const uint32_t sides[3] = {8, 16, 32}, all[3] = {64, 192, 700};
    bench_scene none = {.name = "box"};
    bench_table table;
    bench_table_start(&table, "A closed box that emits",
                      "E at its centre over the true value, after as many steps as cells along a "
                      "side, four times as many, and until it no longer changes.",
                      "mode|cells|1 × the side|4 × the side|at last");
    alp_context_options o = alp_context_options_default();
    ALP_TRY(alp_context_create(&o, &none.context));
    alp_result result = ALP_OK;
    for (int m = 0; m < (options->quick ? 1 : 2); m++) {
        for (int i = 0; i < (options->quick ? 1 : 3) && result == ALP_OK; i++) {
            const uint32_t steps[3] = {sides[i], 4 * sides[i], all[i]};
            double share[3] = {0.0, 0.0, 0.0};
            for (int k = 0; k < 3 && result == ALP_OK; k++) {
                result = find_centre(none.context, (alp_lpv_mode)m, sides[i], steps[k], &share[k]);
            }
            bench_table_add(&table, "%s|%u³|%.2f|%.2f|%.2f", mode_names[m], sides[i], share[0],
                            share[1], share[2]);
        }
    }
    (void)bench_good(&none, result);
    alp_context_destroy(none.context);
    bench_table_print(&table, options);
    return result;
}
