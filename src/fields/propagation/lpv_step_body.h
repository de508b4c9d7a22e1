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

/// Fluxes through faces, summed: of all, and along three axes.
typedef struct flux_sum {
    float all, a, b, c;
} flux_sum;

/// What light sends along axis a through the five faces there. Scalars alone, or the compiler does
/// not vectorise the loop over cells.
/// @param i, va, vb, vc intensity   @param o0 … o4 shares that pass the faces
static inline flux_sum send(const alpi_lpv_scheme *s, float sign, float i, float va, float vb,
                            float vc, float o0, float o1, float o2, float o3, float o4)
{
    const float axis = sign * va;
    const float beside = i + s->along * axis;
    const float b = s->aside * vb, c = s->aside * vc;
    const float far = FAR * larger(i + s->far * axis, 0.0f) * o0;
    const float b0 = SIDE * larger(beside + b, 0.0f) * o1;
    const float b1 = SIDE * larger(beside - b, 0.0f) * o2;
    const float c0 = SIDE * larger(beside + c, 0.0f) * o3;
    const float c1 = SIDE * larger(beside - c, 0.0f) * o4;
    const float sides = (b0 + b1) + (c0 + c1);
    return (flux_sum){far + sides, sign * (far + s->give_along * sides), s->give_aside * (b0 - b1),
                      s->give_aside * (c0 - c1)};
}

/// All that a row of cells needs to know of its surroundings. Directions of travel: +x, −x, +y, −y,
/// +z, −z. What arrives by +x was at x − 1.
typedef struct row_work {
    uint32_t n;
    const alpi_lpv_scheme *scheme;
    wide_row own[TERMS];                       // light of the row itself, of one channel
    const float *from[DIRECTIONS][TERMS];      // light that arrives
    cell_row open[DIRECTIONS][FACES];          // of light that arrives
    cell_row leaving[DIRECTIONS][FACES];       // of light that leaves
    cell_row albedo[3][DIRECTIONS];            // of the faces that it leaves by, by channel
    uint32_t channel;
} row_work;

/// What arrives in a cell by direction d. a, b, c: the terms of its axis and of the two others.
static inline flux_sum arrive(const row_work *w, uint32_t x, bool blocked, int d, int a, int b,
                              int c)
{
    const float sign = d % 2 == 0 ? 1.0f : -1.0f;
    const float *const *p = w->from[d];
    const cell_row *o = w->open[d];
    return send(w->scheme, sign, p[0][x], p[a][x], p[b][x], p[c][x], blocked ? o[0][x] : 1.0f,
                blocked ? o[1][x] : 1.0f, blocked ? o[2][x] : 1.0f, blocked ? o[3][x] : 1.0f,
                blocked ? o[4][x] : 1.0f);
}

/// What the blockers of a cell throw back of the light that leaves it by direction d.
static inline float come_back(const row_work *w, uint32_t x, int d, int a, int b, int c)
{
    const float sign = d % 2 == 0 ? 1.0f : -1.0f;
    const wide_row *p = w->own;
    const cell_row *o = w->leaving[d];
    const flux_sum met = send(w->scheme, sign, p[0][x + 1], p[a][x + 1], p[b][x + 1], p[c][x + 1],
                              1.0f - o[0][x], 1.0f - o[1][x], 1.0f - o[2][x], 1.0f - o[3][x],
                              1.0f - o[4][x]);
    return w->albedo[w->channel][d][x] * met.all;
}

/// One channel of a row. Each face's flux Φ becomes a lobe Φ/π (1/4 + n·ω/2); what comes back, one
/// against the way that it went. Called with constants for each kind of step.
__attribute__((always_inline)) static inline void gather_row(const row_work *w, bool blocked, bool reflects,
                              float *const next[TERMS], float *const sum[TERMS])
{
    const uint32_t n = w->n;
    const float quarter = 0.0795774715f, half = 0.1591549431f; // 1/4π, 1/2π
    EACH_CELL
    {
        const flux_sum x0 = arrive(w, x, blocked, 0, 1, 2, 3), x1 = arrive(w, x, blocked, 1, 1, 2, 3);
        const flux_sum y0 = arrive(w, x, blocked, 2, 2, 3, 1), y1 = arrive(w, x, blocked, 3, 2, 3, 1);
        const flux_sum z0 = arrive(w, x, blocked, 4, 3, 1, 2), z1 = arrive(w, x, blocked, 5, 3, 1, 2);
        float all = (x0.all + x1.all) + (y0.all + y1.all) + (z0.all + z1.all);
        float vx = (x0.a + x1.a) + (y0.c + y1.c) + (z0.b + z1.b);
        float vy = (x0.b + x1.b) + (y0.a + y1.a) + (z0.c + z1.c);
        float vz = (x0.c + x1.c) + (y0.b + y1.b) + (z0.a + z1.a);
        if (reflects) {
            const float back_x0 = come_back(w, x, 0, 1, 2, 3), back_x1 = come_back(w, x, 1, 1, 2, 3);
            const float back_y0 = come_back(w, x, 2, 2, 3, 1), back_y1 = come_back(w, x, 3, 2, 3, 1);
            const float back_z0 = come_back(w, x, 4, 3, 1, 2), back_z1 = come_back(w, x, 5, 3, 1, 2);
            all += (back_x0 + back_x1) + (back_y0 + back_y1) + (back_z0 + back_z1);
            vx += back_x1 - back_x0;
            vy += back_y1 - back_y0;
            vz += back_z1 - back_z0;
        }
        const float i = quarter * all;
        vx *= half;
        vy *= half;
        vz *= half;
        const float scale = scale_of(w->scheme, i, vx, vy, vz);
        sum[0][x] += i;
        sum[1][x] += vx;
        sum[2][x] += vy;
        sum[3][x] += vz;
        next[0][x] = scale * i;
        next[1][x] = scale * vx;
        next[2][x] = scale * vy;
        next[3][x] = scale * vz;
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
                w.from[0][t] = w.own[t];
                w.from[1][t] = w.own[t] + 2;
                for (int i = 0; i < 4; i++) {
                    w.from[2 + i][t] =
                        row_at(g, g->light, ALPI_LPV_ROWS, k, (int64_t)y + beside[i][0],
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
    const alpi_lpv_scheme scheme = step->scheme;
    for (uint32_t block = 3 * first; block < 3 * end; block++) {
        const size_t at = (size_t)block * TERMS * n;
        const float *p0 = g->injected + at, *p1 = p0 + n, *p2 = p1 + n, *p3 = p2 + n;
        float *l0 = g->light + at, *l1 = l0 + n, *l2 = l1 + n, *l3 = l2 + n;
        memcpy(g->sum + at, p0, TERMS * n * sizeof *p0);
        EACH_CELL
        {
            const float scale = scale_of(&scheme, p0[x], p1[x], p2[x], p3[x]);
            l0[x] = scale * p0[x];
            l1[x] = scale * p1[x];
            l2[x] = scale * p2[x];
            l3[x] = scale * p3[x];
        }
    }
}

const alpi_lpv_loops ALPI_VARIANT(alpi_lpv_loops) = {start_rows, step_rows};
