// SPDX-License-Identifier: MIT
// One step of light through a grid, a row of cells at a time, compiled once for each instruction
// set. Cells gather from their neighbours, so that no two rows write to the same place.
#include "fields/propagation/lpv_grid.h"

#include <string.h>

#ifdef __clang__
#define EACH_CELL for (uint32_t x = 0; x < n; x++)
#else
#define EACH_CELL _Pragma("GCC ivdep") for (uint32_t x = 0; x < n; x++)
#endif

enum { TERMS = ALPI_LPV_TERMS, FACES = 5, DIRECTIONS = 6, MOST = ALPI_LPV_SIDE_MOST };
static const float FAR = (float)ALP_LPV_FAR, SIDE = (float)ALP_LPV_SIDE;
static const float PI4 = 12.56637061f;

typedef float cell_row[MOST];
typedef float wide_row[MOST + 2]; // one cell more at each end

static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

static inline float magnitude(float a)
{
    return larger(a, -a);
}

// --- the scale of a cell's fluxes ----------------------------------------------------------------

/// Sum of max(0, i + s a + t b) over the four signs s, t; i, a, b ≥ 0. From max(0, v) = (v + |v|)/2
/// and |u + b| + |u − b| = 2 max(|u|, b).
static inline float sum_of_four(float i, float a, float b)
{
    return 2.0f * i + larger(i + a, b) + larger(magnitude(i - a), b);
}

/// What the fluxes to all 30 faces are multiplied by, so that they add up to 4π p0.
static inline float scale_of(const alpi_lpv_scheme *s, float i, float vx, float vy, float vz)
{
    const float x = magnitude(vx), y = magnitude(vy), z = magnitude(vz);
    const float a = s->along, b = s->aside;
    const float far = 3.0f * i + larger(i, s->far * x) + larger(i, s->far * y) +
                      larger(i, s->far * z);
    const float sides = sum_of_four(i, a * x, b * y) + sum_of_four(i, a * y, b * x) +
                        sum_of_four(i, a * x, b * z) + sum_of_four(i, a * z, b * x) +
                        sum_of_four(i, a * y, b * z) + sum_of_four(i, a * z, b * y);
    const float sum = FAR * far + SIDE * sides;
    return PI4 * i / larger(sum, 1e-30f);
}

// --- what blocks light ---------------------------------------------------------------------------

static inline float clamp_open(float opacity)
{
    const float open = 1.0f - opacity;
    return open < 0.0f ? 0.0f : (open > 1.0f ? 1.0f : open);
}

/// Shares of light that pass a face, travelling along an axis: to the far face, and to the sides
/// at + and − of the other two axes. Blockers are read against the way of the light.
/// @param sign of travel   @param g opacity of the face: term 0, its axis, and the others
static void find_open(const alpi_lpv_scheme *s, uint32_t n, float sign, const float *g0,
                      const float *ga, const float *gb, const float *gc, cell_row open[FACES])
{
    EACH_CELL
    {
        const float axis = sign * ga[x];
        const float beside = g0[x] - s->along * axis;
        const float b = s->aside * gb[x], c = s->aside * gc[x];
        open[0][x] = clamp_open(g0[x] - axis);
        open[1][x] = clamp_open(beside - b);
        open[2][x] = clamp_open(beside + b);
        open[3][x] = clamp_open(beside - c);
        open[4][x] = clamp_open(beside + c);
    }
}

// --- gathering -----------------------------------------------------------------------------------

/// Fluxes that arrive in a cell, as sums over faces: of all, and along the axes.
typedef struct flux_sum {
    float all, axis[3];
} flux_sum;

/// Adds what a neighbour sends along axis A. B and C are the other axes.
/// @param i, va, vb, vc intensity of the neighbour   @param open shares that pass, five faces
static inline void add_flux(const alpi_lpv_scheme *s, int a, int b, int c, float sign, float i,
                            const float v[3], const float open[FACES], flux_sum *f)
{
    const float axis = sign * v[a];
    const float beside = i + s->along * axis;
    const float vb = s->aside * v[b], vc = s->aside * v[c];
    const float far = FAR * larger(i + s->far * axis, 0.0f) * open[0];
    const float b0 = SIDE * larger(beside + vb, 0.0f) * open[1];
    const float b1 = SIDE * larger(beside - vb, 0.0f) * open[2];
    const float c0 = SIDE * larger(beside + vc, 0.0f) * open[3];
    const float c1 = SIDE * larger(beside - vc, 0.0f) * open[4];
    const float sides = b0 + b1 + c0 + c1;
    f->all += far + sides;
    f->axis[a] += sign * (far + s->give_along * sides);
    f->axis[b] += s->give_aside * (b0 - b1);
    f->axis[c] += s->give_aside * (c0 - c1);
}

/// What a cell's blockers throw back of the light that it sends along axis A: a lobe against the
/// way of the light.
static inline void add_reflected(const alpi_lpv_scheme *s, int a, int b, int c, float sign, float i,
                                 const float v[3], const float open[FACES], float albedo,
                                 flux_sum *f)
{
    const float shut[FACES] = {1.0f - open[0], 1.0f - open[1], 1.0f - open[2], 1.0f - open[3],
                               1.0f - open[4]};
    flux_sum met = {0.0f, {0.0f, 0.0f, 0.0f}};
    add_flux(s, a, b, c, sign, i, v, shut, &met);
    f->all += albedo * met.all;
    f->axis[a] -= sign * albedo * met.all;
}

/// All that a row of cells needs to know of its surroundings.
typedef struct row_work {
    uint32_t n;
    const alpi_lpv_scheme *scheme;
    wide_row own[TERMS];                     // light of the row itself, of one channel
    const float *beside[4][TERMS];           // of the rows at −y, +y, −z, +z
    cell_row open[DIRECTIONS][FACES];        // of light that arrives, by direction of travel
    cell_row leaving[DIRECTIONS][FACES];     // of light that leaves, by direction of travel
    cell_row albedo[3][DIRECTIONS];          // of the faces that it leaves by, by channel
    uint32_t channel;
} row_work;

/// What arrives in a cell by direction of travel d, along axis A, and what of its own light its
/// blockers throw back from there.
static inline void gather_from(const row_work *w, uint32_t x, bool blocked, bool reflects, int d,
                               int a, int b, int c, flux_sum *f)
{
    const float sign = d % 2 == 0 ? 1.0f : -1.0f;
    float p[TERMS], open[FACES];
    for (int t = 0; t < TERMS; t++) { // what arrives by +x was at x − 1
        p[t] = d < 2 ? w->own[t][x + (d == 0 ? 0 : 2)] : w->beside[d < 2 ? 0 : d - 2][t][x];
    }
    for (int k = 0; k < FACES; k++) {
        open[k] = blocked ? w->open[d][k][x] : 1.0f;
    }
    add_flux(w->scheme, a, b, c, sign, p[0], p + 1, open, f);
    if (reflects) {
        for (int t = 0; t < TERMS; t++) {
            p[t] = w->own[t][x + 1];
        }
        for (int k = 0; k < FACES; k++) {
            open[k] = w->leaving[d][k][x];
        }
        add_reflected(w->scheme, a, b, c, sign, p[0], p + 1, open, w->albedo[w->channel][d][x],
                      f);
    }
}

/// Fluxes to an intensity: each is a lobe of Φ/π (1/4 + n·ω/2). Writes it, scaled for the next
/// step, and adds it to the sum.
static inline void give(const alpi_lpv_scheme *s, const flux_sum *f, uint32_t x, float *const *next,
                        float *const *sum)
{
    const float quarter = 0.0795774715f, half = 0.1591549431f; // 1/4π, 1/2π
    const float i = quarter * f->all;
    const float vx = half * f->axis[0], vy = half * f->axis[1], vz = half * f->axis[2];
    const float scale = scale_of(s, i, vx, vy, vz);
    sum[0][x] += i;
    sum[1][x] += vx;
    sum[2][x] += vy;
    sum[3][x] += vz;
    next[0][x] = scale * i;
    next[1][x] = scale * vx;
    next[2][x] = scale * vy;
    next[3][x] = scale * vz;
}

/// One channel of a row. Written once for each kind of step, so that the compiler sees which.
static inline void gather_row(const row_work *w, bool blocked, bool reflects, float *const *next,
                              float *const *sum)
{
    const uint32_t n = w->n;
    EACH_CELL
    {
        flux_sum f = {0.0f, {0.0f, 0.0f, 0.0f}};
        gather_from(w, x, blocked, reflects, 0, 0, 1, 2, &f);
        gather_from(w, x, blocked, reflects, 1, 0, 1, 2, &f);
        gather_from(w, x, blocked, reflects, 2, 1, 2, 0, &f);
        gather_from(w, x, blocked, reflects, 3, 1, 2, 0, &f);
        gather_from(w, x, blocked, reflects, 4, 2, 0, 1, &f);
        gather_from(w, x, blocked, reflects, 5, 2, 0, 1, &f);
        give(w->scheme, &f, x, next, sum);
    }
}

// --- rows and their neighbours -------------------------------------------------------------------

static const float nothing[MOST]; // a row of no light, or of no blockers

/// Row `row` of the block of `rows` rows at (y + dy, z + dz); nothing beyond the grid.
static const float *row_at(const alpi_lpv_grid *g, const float *volume, uint32_t rows, uint32_t row,
                           int64_t y, int64_t z, bool wraps)
{
    const int64_t ny = g->size[1], nz = g->size[2];
    if (y < 0 || z < 0 || y >= ny || z >= nz) {
        if (!wraps) {
            return nothing;
        }
        y = (y + ny) % ny;
        z = (z + nz) % nz;
    }
    return volume + (((size_t)z * (size_t)ny + (size_t)y) * rows + row) * g->size[0];
}

static void widen(wide_row wide, const float *row, uint32_t n, bool wraps)
{
    memcpy(wide + 1, row, n * sizeof *row);
    wide[0] = wraps ? row[n - 1] : 0.0f;
    wide[n + 1] = wraps ? row[0] : 0.0f;
}

/// Blockers of the six faces of each cell of a row: its own low faces, and those of the cells
/// beyond its high faces.
static void find_blockers(const alpi_lpv_grid *g, const alpi_lpv_step *step, uint32_t y, uint32_t z,
                          row_work *w)
{
    static const int others[3][2] = {{1, 2}, {2, 0}, {0, 1}};
    wide_row wide[TERMS + 3];
    for (int a = 0; a < 3; a++) {
        for (int high = 0; high < 2; high++) {
            const float *rows[TERMS + 3];
            const int64_t at_y = y + (a == 1 && high), at_z = z + (a == 2 && high);
            for (uint32_t t = 0; t < TERMS + 3; t++) {
                const uint32_t row = t < TERMS ? (uint32_t)a * TERMS + t
                                               : 3 * TERMS + (uint32_t)a * 3 + (t - TERMS);
                rows[t] = row_at(g, g->faces, ALPI_LPV_FACE_ROWS, row, at_y, at_z, step->wraps);
                if (a == 0 && high) {
                    widen(wide[t], rows[t], w->n, step->wraps);
                    rows[t] = wide[t] + 2;
                }
            }
            // Light enters by the low face in the direction of + and leaves by it in that of −.
            const int in = 2 * a + high, out = 2 * a + 1 - high;
            const float sign = high ? -1.0f : 1.0f;
            const float *gb = rows[1 + others[a][0]], *gc = rows[1 + others[a][1]];
            find_open(w->scheme, w->n, sign, rows[0], rows[1 + a], gb, gc, w->open[in]);
            if (step->reflects) {
                find_open(w->scheme, w->n, -sign, rows[0], rows[1 + a], gb, gc, w->leaving[out]);
                for (int k = 0; k < 3; k++) {
                    memcpy(w->albedo[k][out], rows[TERMS + k], w->n * sizeof(float));
                }
            }
        }
    }
}

static void step_rows(const alpi_lpv_grid *g, const alpi_lpv_step *step, uint32_t first,
                      uint32_t end)
{
    static const int beside[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    row_work w;
    w.n = g->size[0];
    w.scheme = &step->scheme;
    for (uint32_t row = first; row < end; row++) {
        const uint32_t y = row % g->size[1], z = row / g->size[1];
        if (step->blocked) {
            find_blockers(g, step, y, z, &w);
        }
        for (uint32_t channel = 0; channel < 3; channel++) {
            float *next[TERMS], *sum[TERMS];
            w.channel = channel;
            for (uint32_t t = 0; t < TERMS; t++) {
                const uint32_t k = channel * TERMS + t;
                const size_t own = ((size_t)row * ALPI_LPV_ROWS + k) * w.n;
                next[t] = g->next + own;
                sum[t] = g->sum + own;
                widen(w.own[t], g->light + own, w.n, step->wraps);
                for (int i = 0; i < 4; i++) {
                    w.beside[i][t] = row_at(g, g->light, ALPI_LPV_ROWS, k, (int64_t)y + beside[i][0],
                                            (int64_t)z + beside[i][1], step->wraps);
                }
            }
            if (step->reflects) {
                gather_row(&w, true, true, next, sum);
            } else if (step->blocked) {
                gather_row(&w, true, false, next, sum);
            } else {
                gather_row(&w, false, false, next, sum);
            }
        }
    }
}

static void start_rows(const alpi_lpv_grid *g, const alpi_lpv_step *step, uint32_t first,
                       uint32_t end)
{
    const uint32_t n = g->size[0];
    for (uint32_t block = 3 * first; block < 3 * end; block++) {
        const size_t at = (size_t)block * TERMS * n;
        const float *restrict p = g->injected + at;
        float *restrict light = g->light + at, *restrict sum = g->sum + at;
        memcpy(sum, p, TERMS * n * sizeof *p);
        EACH_CELL
        {
            const float scale = scale_of(&step->scheme, p[x], p[n + x], p[2 * n + x], p[3 * n + x]);
            for (uint32_t t = 0; t < TERMS; t++) {
                light[t * n + x] = scale * p[t * n + x];
            }
        }
    }
}

const alpi_lpv_loops ALPI_VARIANT(alpi_lpv_loops) = {start_rows, step_rows};
