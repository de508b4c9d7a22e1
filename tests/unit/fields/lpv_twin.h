// SPDX-License-Identifier: MIT
// A slow twin of the propagation: in double, a loop over cells, directions and faces that scatters,
// written from the formulas of physics and without a line of the library's.
#ifndef LPV_TWIN_H
#define LPV_TWIN_H

#include "fields/propagation/lpv.h"
#include "test_support.h"

#include <math.h>
#include <stdlib.h>

enum { TWIN_ROWS = 12, TWIN_NODE = 7 };

/// How light is read at faces and given on, as in alpi_lpv_scheme.
typedef struct twin_scheme {
    double far, along, aside, give_along, give_aside, opacity;
    bool clamps;   // false: the operator is linear, and some light is negative
    bool by_angle; // blockers of one orientation stop by the cosine, the rest by half
} twin_scheme;

typedef struct twin {
    int n[3];
    bool wraps;
    twin_scheme scheme;
    double *light, *next, *sum; // [z][y][x][channel][p0, px, py, pz]
    const float *nodes;         // opacities at corners, [z][y][x][TWIN_NODE]; NULL: none
    bool reflects;
} twin;

static inline twin_scheme twin_scheme_of(alp_lpv_mode mode)
{
    const double along = 2.0 / sqrt(5.0), aside = 1.0 / sqrt(5.0);
    if (mode == ALP_LPV_CONFORMANCE) {
        return (twin_scheme){1.0, along, aside, 0.0, 1.0, 1.0, true, false};
    }
    return (twin_scheme){1.0, along, aside, along, aside, 1.6, true, true};
}

static inline size_t twin_cells(const twin *t)
{
    return (size_t)t->n[0] * (size_t)t->n[1] * (size_t)t->n[2];
}

static inline void twin_open(twin *t, const int n[3], twin_scheme scheme, bool wraps)
{
    *t = (twin){.n = {n[0], n[1], n[2]}, .wraps = wraps, .scheme = scheme};
    t->light = calloc(twin_cells(t) * TWIN_ROWS, sizeof *t->light);
    t->next = calloc(twin_cells(t) * TWIN_ROWS, sizeof *t->next);
    t->sum = calloc(twin_cells(t) * TWIN_ROWS, sizeof *t->sum);
    assert_true(t->light != NULL && t->next != NULL && t->sum != NULL);
}

static inline void twin_close(twin *t)
{
    free(t->light);
    free(t->next);
    free(t->sum);
}

static inline double *twin_cell(const twin *t, double *volume, const int at[3])
{
    const size_t cell = ((size_t)at[2] * (size_t)t->n[1] + (size_t)at[1]) * (size_t)t->n[0];
    return volume + (cell + (size_t)at[0]) * TWIN_ROWS;
}

/// Opacity of the face that is crossed from a cell along ±axis, for light that travels along w;
/// and the albedo of what blocks there.
static inline double twin_opacity(const twin *t, const int cell[3], int axis, int sign,
                                  const double w[3], double albedo[3])
{
    double sum[TWIN_NODE] = {0.0};
    int at[3] = {cell[0], cell[1], cell[2]};
    at[axis] += sign > 0;
    for (int corner = 0; corner < 4; corner++) {
        int node[3] = {at[0], at[1], at[2]};
        node[(axis + 1) % 3] += corner & 1;
        node[(axis + 2) % 3] += corner >> 1;
        const int wide = t->n[0] + 1, high = t->n[1] + 1;
        for (int k = 0; k < TWIN_NODE; k++) {
            const float value =
                t->nodes[((node[2] * high + node[1]) * wide + node[0]) * TWIN_NODE + k];
            sum[k] += (double)value / 4.0;
        }
    }
    for (int k = 0; k < 3; k++) {
        albedo[k] = sum[0] > 0.0 ? sum[4 + k] / sum[0] : 0.0;
    }
    double met = sum[0] - sum[1] * w[0] - sum[2] * w[1] - sum[3] * w[2];
    if (t->scheme.by_angle) {
        const double area = 4.0 * sum[0], v[3] = {2.0 * sum[1], 2.0 * sum[2], 2.0 * sum[3]};
        const double one_way = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        met = fmax((area - one_way) / 2.0, 0.0) - v[0] * w[0] - v[1] * w[1] - v[2] * w[2];
    }
    return fmin(fmax(t->scheme.opacity * met, 0.0), 1.0);
}

/// Adds a lobe of flux Φ about n: Φ/π (1/4 + n·ω/2).
static inline void twin_give(double *p, double flux, const double n[3])
{
    const double pi = acos(-1.0);
    p[0] += flux / pi / 4.0;
    for (int k = 0; k < 3; k++) {
        p[1 + k] += flux / pi / 2.0 * n[k];
    }
}

/// Sends the light of one channel of a cell through the 30 faces, or only measures its flux.
static inline double twin_send(twin *t, const int cell[3], int channel, double scale, bool blocked,
                               bool measure)
{
    const double pi = acos(-1.0), far = 4.0 * asin(0.1), side = (2.0 * pi / 3.0 - far) / 4.0;
    const double *p = twin_cell(t, t->light, cell) + 4 * channel;
    double all = 0.0;
    for (int d = 0; d < 6; d++) {
        const int axis = d / 2, sign = d % 2 == 0 ? 1 : -1;
        for (int face = 0; face < 5; face++) {
            double w[3] = {0.0, 0.0, 0.0}, n[3] = {0.0, 0.0, 0.0};
            w[axis] = face == 0 ? sign : t->scheme.along * sign;
            n[axis] = face == 0 ? sign : t->scheme.give_along * sign;
            if (face > 0) {
                const int other = (axis + 1 + (face - 1) / 2) % 3, way = face % 2 == 1 ? 1 : -1;
                w[other] = t->scheme.aside * way;
                n[other] = t->scheme.give_aside * way;
            }
            const double longer = face == 0 ? t->scheme.far : 1.0;
            const double i = p[0] + longer * (p[1] * w[0] + p[2] * w[1] + p[3] * w[2]);
            double flux = (face == 0 ? far : side) * (t->scheme.clamps ? fmax(i, 0.0) : i) * scale;
            all += flux;
            if (measure) {
                continue;
            }
            if (blocked) {
                double albedo[3], back[3] = {0.0, 0.0, 0.0};
                const double opacity = twin_opacity(t, cell, axis, sign, w, albedo);
                back[axis] = -sign;
                if (t->reflects) {
                    twin_give(twin_cell(t, t->next, cell) + 4 * channel,
                              flux * opacity * albedo[channel], back);
                }
                flux *= 1.0 - opacity;
            }
            int to[3] = {cell[0], cell[1], cell[2]};
            to[axis] += sign;
            if (t->wraps) {
                to[axis] = (to[axis] + t->n[axis]) % t->n[axis];
            }
            if (to[axis] >= 0 && to[axis] < t->n[axis]) {
                twin_give(twin_cell(t, t->next, to) + 4 * channel, flux, n);
            }
        }
    }
    return all;
}

static inline void twin_step(twin *t, bool blocked)
{
    const double pi = acos(-1.0);
    const size_t values = twin_cells(t) * TWIN_ROWS;
    memset(t->next, 0, values * sizeof *t->next);
    for (int z = 0; z < t->n[2]; z++) {
        for (int y = 0; y < t->n[1]; y++) {
            for (int x = 0; x < t->n[0]; x++) {
                const int cell[3] = {x, y, z};
                for (int c = 0; c < 3; c++) {
                    const double wanted = 4.0 * pi * twin_cell(t, t->light, cell)[4 * c];
                    const double all = twin_send(t, cell, c, 1.0, false, true);
                    const double scale = t->scheme.clamps && all > 0.0 ? wanted / all : 1.0;
                    (void)twin_send(t, cell, c, scale, blocked, false);
                }
            }
        }
    }
    double *swap = t->light;
    t->light = t->next;
    t->next = swap;
    for (size_t i = 0; i < values; i++) {
        t->sum[i] += t->light[i];
    }
}

/// Takes what was injected into a grid.
static inline void twin_take(twin *t, const alpi_lpv_grid *g)
{
    for (int z = 0; z < t->n[2]; z++) {
        for (int y = 0; y < t->n[1]; y++) {
            for (int x = 0; x < t->n[0]; x++) {
                const int cell[3] = {x, y, z};
                const size_t row = (size_t)z * (size_t)t->n[1] + (size_t)y;
                for (size_t k = 0; k < TWIN_ROWS; k++) {
                    const double v =
                        (double)g->injected[(row * TWIN_ROWS + k) * (size_t)t->n[0] + (size_t)x];
                    twin_cell(t, t->light, cell)[k] = v;
                    twin_cell(t, t->sum, cell)[k] = v;
                }
            }
        }
    }
}

static inline double twin_flux(const twin *t, const double *light)
{
    double sum = 0.0;
    for (size_t i = 0; i < twin_cells(t) * TWIN_ROWS; i += 4) {
        sum += light[i];
    }
    return 4.0 * acos(-1.0) * sum;
}

#endif
