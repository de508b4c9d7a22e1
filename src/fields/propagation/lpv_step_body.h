// SPDX-License-Identifier: MIT
// One step of light through a grid, a row of cells at a time, compiled once for each instruction
// set. Cells gather from their neighbours, so that no two rows write to the same place.
#include "fields/propagation/lpv_grid.h"

#include <math.h>
#include <string.h>

#ifdef __clang__
#define EACH_CELL for (uint32_t x = 0; x < n; x++)
#else
#define EACH_CELL _Pragma("GCC ivdep") for (uint32_t x = 0; x < n; x++)
#endif

enum { TERMS = ALPI_LPV_TERMS, FACES = 5, DIRECTIONS = 6, MOST = ALPI_LPV_SIDE_MOST };
static const float FAR = (float)ALP_LPV_FAR, SIDE = (float)ALP_LPV_SIDE;
static const float PI4 = 12.56637061f;

/// Rows of a work area lie this many floats apart: powers of two would share few lines of the cache.
enum { PAD = 24, STRIDE_MOST = MOST + PAD };

static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

// --- the scale of a cell's fluxes ----------------------------------------------------------------

/// Cosines of the directions in which faces are read, over that of side faces aside, as `light`
/// holds p × `aside`. By value, or the compiler reads them again after each store.
typedef struct reading {
    float straight, along;
} reading;

static inline reading reading_of(const alpi_lpv_scheme *s)
{
    return (reading){s->far / s->aside, s->along / s->aside};
}

/// Sum of max(0, i + s a + t b) over the four signs s, t, less 2 i; i, a, b ≥ 0. From max(0, v) =
/// (v + |v|)/2 and |w + b| + |w − b| = 2 max(|w|, b).
static inline float sum_of_four(float i, float a, float b)
{
    return larger(i + a, b) + larger(fabsf(i - a), b);
}

/// What the fluxes to all 30 faces are multiplied by, so that they add up to 4π p0.
/// @param vx, vy, vz the terms along the axes × `aside`, as `light` holds them
static inline float scale_of(reading r, float i, float vx, float vy, float vz)
{
    const float x = fabsf(vx), y = fabsf(vy), z = fabsf(vz);
    const float along = r.along, straight = r.straight;
    const float far = larger(i, straight * x) + larger(i, straight * y) + larger(i, straight * z);
    const float ax = along * x, ay = along * y, az = along * z;
    const float sides = (sum_of_four(i, ax, y) + sum_of_four(i, ax, z)) +
                        (sum_of_four(i, ay, x) + sum_of_four(i, ay, z)) +
                        (sum_of_four(i, az, x) + sum_of_four(i, az, y));
    const float sum = FAR * (3.0f * i + far) + SIDE * (12.0f * i + sides);
    return PI4 * i / larger(sum, 1e-30f);
}

// --- what blocks light ---------------------------------------------------------------------------

static inline float clamp_open(float open)
{
    return open < 0.0f ? 0.0f : (open > 1.0f ? 1.0f : open);
}

/// Shares of light that pass a face, travelling along an axis: to the far face, and to the sides
/// at + and − of the other two axes.
/// @param sign of travel   @param g openness of the face: term 0, its axis, and the others
static void find_open(const alpi_lpv_scheme *s, uint32_t n, float sign, const float *g0,
                      const float *ga, const float *gb, const float *gc, size_t stride, float *open)
{
    const float along = sign * s->along, aside = s->aside;
    float *o1 = open + stride, *o2 = o1 + stride, *o3 = o2 + stride, *o4 = o3 + stride;
    EACH_CELL
    {
        const float beside = g0[x] + along * ga[x];
        const float b = aside * gb[x], c = aside * gc[x];
        open[x] = clamp_open(g0[x] + sign * ga[x]);
        o1[x] = clamp_open(beside + b);
        o2[x] = clamp_open(beside - b);
        o3[x] = clamp_open(beside + c);
        o4[x] = clamp_open(beside - c);
    }
}

// --- gathering -----------------------------------------------------------------------------------

/// What passes five faces, per solid angle: the far one, the sum of the four at the sides, and
/// their differences along the other two axes.
typedef struct passed {
    float far, sides, b, c;
} passed;

/// What light sends along an axis. Scalars alone, or the compiler does not vectorise the loop over
/// cells.
/// @param i, va, vb, vc light of a cell: va along the axis   @param o0 … o4 shares that pass
static inline passed send(reading r, float sign, float i, float va, float vb,
                          float vc, float o0, float o1, float o2, float o3, float o4)
{
    const float beside = i + sign * r.along * va;
    const float b0 = larger(beside + vb, 0.0f) * o1, b1 = larger(beside - vb, 0.0f) * o2;
    const float c0 = larger(beside + vc, 0.0f) * o3, c1 = larger(beside - vc, 0.0f) * o4;
    const float far = larger(i + sign * r.straight * va, 0.0f) * o0;
    return (passed){far, (b0 + b1) + (c0 + c1), b0 - b1, c0 - c1};
}

/// All that a row of cells needs to know of its surroundings. Directions of travel: +x, −x, +y, −y,
/// +z, −z. What arrives by +x was at x − 1.
typedef struct row_work {
    uint32_t n, channel;
    size_t stride; // of rows below, floats
    alpi_lpv_scheme scheme;
    const float *from[DIRECTIONS][TERMS];           // light that arrives
    float own[TERMS * STRIDE_MOST];                 // light of the row, a cell more at each end
    float open[DIRECTIONS * FACES * STRIDE_MOST];   // shares of light that arrive
    float leave[DIRECTIONS * FACES * STRIDE_MOST];  // shares of light that leave
    float albedo[3 * DIRECTIONS * STRIDE_MOST];     // of the faces that it leaves by, by channel
} row_work;

/// What arrives in a cell by direction d. a, b, c: the terms of its axis and of the two others.
static inline passed arrive(const row_work *w, reading r, uint32_t x, bool blocked, int d, int a,
                            int b, int c)
{
    const float sign = d % 2 == 0 ? 1.0f : -1.0f;
    const float *const *p = w->from[d];
    const size_t k = w->stride;
    const float *o = w->open + (size_t)d * FACES * k + x;
    return send(r, sign, p[0][x], p[a][x], p[b][x], p[c][x], blocked ? o[0] : 1.0f,
                blocked ? o[k] : 1.0f, blocked ? o[2 * k] : 1.0f, blocked ? o[3 * k] : 1.0f,
                blocked ? o[4 * k] : 1.0f);
}

/// Flux that the blockers of a cell throw back of the light that leaves it by direction d.
static inline float come_back(const row_work *w, reading r, uint32_t x, int d, int a, int b, int c)
{
    const float sign = d % 2 == 0 ? 1.0f : -1.0f;
    const size_t k = w->stride;
    const float *p = w->own + x + 1, *o = w->leave + (size_t)d * FACES * k + x;
    const passed met =
        send(r, sign, p[0], p[(size_t)a * k], p[(size_t)b * k], p[(size_t)c * k],
             1.0f - o[0], 1.0f - o[k], 1.0f - o[2 * k], 1.0f - o[3 * k], 1.0f - o[4 * k]);
    return w->albedo[(w->channel * DIRECTIONS + (size_t)d) * k + x] * (FAR * met.far + SIDE * met.sides);
}

/// One channel of a row. Each face's flux Φ becomes a lobe Φ/π (1/4 + n·ω/2); what comes back, one
/// against the way that it went. Called with constants for each kind of step.
__attribute__((always_inline)) static inline void gather_row(const row_work *w, bool blocked,
                                                             bool reflects,
                                                             float *const next[TERMS],
                                                             float *const sum[TERMS])
{
    const uint32_t n = w->n;
    const reading r = reading_of(&w->scheme);
    const float aside = w->scheme.aside;
    const float quarter = 0.0795774715f, half = 0.1591549431f; // 1/4π, 1/2π
    const float give_far = half * FAR, give_along = half * SIDE * w->scheme.give_along;
    const float give_aside = half * SIDE * w->scheme.give_aside;
    EACH_CELL
    {
        // Axis by axis, so that few values wait in registers.
        const passed x0 = arrive(w, r, x, blocked, 0, 1, 2, 3);
        const passed x1 = arrive(w, r, x, blocked, 1, 1, 2, 3);
        float far = x0.far + x1.far, sides = x0.sides + x1.sides;
        float vx = give_far * (x0.far - x1.far) + give_along * (x0.sides - x1.sides);
        float vy = give_aside * (x0.b + x1.b), vz = give_aside * (x0.c + x1.c);
        const passed y0 = arrive(w, r, x, blocked, 2, 2, 3, 1);
        const passed y1 = arrive(w, r, x, blocked, 3, 2, 3, 1);
        far += y0.far + y1.far;
        sides += y0.sides + y1.sides;
        vy += give_far * (y0.far - y1.far) + give_along * (y0.sides - y1.sides);
        vz += give_aside * (y0.b + y1.b);
        vx += give_aside * (y0.c + y1.c);
        const passed z0 = arrive(w, r, x, blocked, 4, 3, 1, 2);
        const passed z1 = arrive(w, r, x, blocked, 5, 3, 1, 2);
        far += z0.far + z1.far;
        sides += z0.sides + z1.sides;
        vz += give_far * (z0.far - z1.far) + give_along * (z0.sides - z1.sides);
        vx += give_aside * (z0.b + z1.b);
        vy += give_aside * (z0.c + z1.c);
        float i = quarter * (FAR * far + SIDE * sides);
        if (reflects) {
            const float rx0 = come_back(w, r, x, 0, 1, 2, 3), rx1 = come_back(w, r, x, 1, 1, 2, 3);
            const float ry0 = come_back(w, r, x, 2, 2, 3, 1), ry1 = come_back(w, r, x, 3, 2, 3, 1);
            const float rz0 = come_back(w, r, x, 4, 3, 1, 2), rz1 = come_back(w, r, x, 5, 3, 1, 2);
            i += quarter * ((rx0 + rx1) + (ry0 + ry1) + (rz0 + rz1));
            vx += half * (rx1 - rx0);
            vy += half * (ry1 - ry0);
            vz += half * (rz1 - rz0);
        }
        sum[0][x] += i;
        sum[1][x] += vx;
        sum[2][x] += vy;
        sum[3][x] += vz;
        vx *= aside;
        vy *= aside;
        vz *= aside;
        const float scale = scale_of(r, i, vx, vy, vz);
        next[0][x] = scale * i;
        next[1][x] = scale * vx;
        next[2][x] = scale * vy;
        next[3][x] = scale * vz;
    }
}

// --- rows and their neighbours -------------------------------------------------------------------

/// Rows of a block without light, or without blockers: all is open.
static const float dark[ALPI_LPV_ROWS * MOST];

/// The block of rows at (y, z); `beyond` outside of the grid.
static const float *block_at(const alpi_lpv_grid *g, const float *volume, uint32_t rows, int64_t y,
                             int64_t z, bool wraps, const float *beyond)
{
    const int64_t ny = g->size[1], nz = g->size[2];
    if (y < 0 || z < 0 || y >= ny || z >= nz) {
        if (!wraps) {
            return beyond;
        }
        y = (y + ny) % ny;
        z = (z + nz) % nz;
    }
    return volume + ((size_t)z * (size_t)ny + (size_t)y) * rows * g->size[0];
}

/// A row with one cell more at each end.
static void widen(float *wide, const float *row, uint32_t n, bool wraps, float beyond)
{
    EACH_CELL
    {
        wide[x + 1] = row[x];
    }
    wide[0] = wraps ? row[n - 1] : beyond;
    wide[n + 1] = wraps ? row[0] : beyond;
}

/// Blockers of the six faces of each cell of a row: its own low faces, and those of the cells
/// beyond its high faces.
static void find_blockers(const alpi_lpv_grid *g, const alpi_lpv_step *step, uint32_t y, uint32_t z,
                          const float *open, row_work *w)
{
    float wide[(TERMS + 3) * STRIDE_MOST];
    for (size_t a = 0; a < 3; a++) {
        for (int high = 0; high < 2; high++) {
            const float *block =
                block_at(g, g->faces, ALPI_LPV_FACE_ROWS, (int64_t)y + (a == 1 && high),
                         (int64_t)z + (a == 2 && high), step->wraps, open);
            const float *rows[TERMS + 3];
            for (size_t t = 0; t < TERMS + 3; t++) {
                rows[t] = block + (t < TERMS ? a * TERMS + t : 3 * TERMS + a * 3 + t - TERMS) * w->n;
                if (a == 0 && high) {
                    float *row = wide + t * w->stride;
                    widen(row, rows[t], w->n, step->wraps, t == 0 ? 1.0f : 0.0f);
                    rows[t] = row + 2;
                }
            }
            // Light enters by the low face in the direction of + and leaves by it in that of −.
            const size_t in = 2 * a + (size_t)high, out = 2 * a + 1 - (size_t)high;
            const float sign = high ? -1.0f : 1.0f;
            const float *gb = rows[1 + (a + 1) % 3], *gc = rows[1 + (a + 2) % 3];
            find_open(&w->scheme, w->n, sign, rows[0], rows[1 + a], gb, gc, w->stride,
                      w->open + in * FACES * w->stride);
            if (step->reflects) {
                find_open(&w->scheme, w->n, -sign, rows[0], rows[1 + a], gb, gc, w->stride,
                          w->leave + out * FACES * w->stride);
                for (size_t k = 0; k < 3; k++) {
                    memcpy(w->albedo + (k * DIRECTIONS + out) * w->stride, rows[TERMS + k],
                           w->n * sizeof(float));
                }
            }
        }
    }
}

static void step_rows(const alpi_lpv_grid *g, const alpi_lpv_step *step, uint32_t first,
                      uint32_t end)
{
    static const int beside[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    float open[ALPI_LPV_FACE_ROWS * MOST] = {0.0f}; // beyond the grid
    row_work w;
    w.n = g->size[0];
    w.stride = w.n + PAD;
    w.scheme = step->scheme;
    for (size_t x = 0; x < w.n && step->blocked; x++) {
        open[x] = open[TERMS * w.n + x] = open[2 * TERMS * w.n + x] = 1.0f;
    }
    for (uint32_t row = first; row < end; row++) {
        const uint32_t y = row % g->size[1], z = row / g->size[1];
        const float *blocks[4];
        for (int i = 0; i < 4; i++) {
            blocks[i] = block_at(g, g->light, ALPI_LPV_ROWS, (int64_t)y + beside[i][0],
                                 (int64_t)z + beside[i][1], step->wraps, dark);
        }
        if (step->blocked) {
            find_blockers(g, step, y, z, open, &w);
        }
        for (w.channel = 0; w.channel < 3; w.channel++) {
            float *next[TERMS], *sum[TERMS];
            for (size_t t = 0; t < TERMS; t++) {
                const size_t k = (w.channel * TERMS + t) * w.n;
                const size_t own = (size_t)row * ALPI_LPV_ROWS * w.n + k;
                next[t] = g->next + own;
                sum[t] = g->sum + own;
                float *wide = w.own + t * w.stride;
                widen(wide, g->light + own, w.n, step->wraps, 0.0f);
                w.from[0][t] = wide;
                w.from[1][t] = wide + 2;
                for (int i = 0; i < 4; i++) {
                    w.from[2 + i][t] = blocks[i] + k;
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
    const float aside = step->scheme.aside;
    const reading r = reading_of(&step->scheme);
    for (uint32_t block = 3 * first; block < 3 * end; block++) {
        const size_t at = (size_t)block * TERMS * n;
        const float *p0 = g->injected + at, *p1 = p0 + n, *p2 = p1 + n, *p3 = p2 + n;
        float *l0 = g->light + at, *l1 = l0 + n, *l2 = l1 + n, *l3 = l2 + n;
        memcpy(g->sum + at, p0, TERMS * n * sizeof *p0);
        EACH_CELL
        {
            const float vx = aside * p1[x], vy = aside * p2[x], vz = aside * p3[x];
            const float scale = scale_of(r, p0[x], vx, vy, vz);
            l0[x] = scale * p0[x];
            l1[x] = scale * vx;
            l2[x] = scale * vy;
            l3[x] = scale * vz;
        }
    }
}

const alpi_lpv_loops ALPI_VARIANT(alpi_lpv_loops) = {start_rows, step_rows};
