// SPDX-License-Identifier: MIT
// One step of light through a grid, a row of cells at a time, compiled once for each instruction
// set. Cells gather from their neighbours, so that no two rows write to the same place.
#include "fields/propagation/lpv_faces_body.h"

#include <string.h>

static const float FAR = (float)ALP_LPV_FAR, SIDE = (float)ALP_LPV_SIDE;
static const float PI4 = 12.56637061f;

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

/// Factor on the fluxes to all 30 faces, with which they add up to 4π p0.
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

// --- gathering -----------------------------------------------------------------------------------

/// Light that passes five faces, per solid angle: the far one, the sum of the four at the sides,
/// and their differences along the other two axes.
typedef struct passed {
    float far, sides, b, c;
} passed;

/// Light of a cell: I(ω) = i + …, va along an axis.
typedef struct cell_light {
    float i, va, vb, vc;
} cell_light;

/// Light that a cell sends along an axis. Scalars, or the compiler does not vectorise the loop over
/// cells.
/// @param o0 … o4 shares that pass the far face, and sides at + and − of two axes
ALWAYS_INLINE passed send(reading r, float sign, cell_light p, float o0, float o1, float o2,
                          float o3, float o4)
{
    const float beside = p.i + sign * r.along * p.va;
    const float b0 = larger(beside + p.vb, 0.0f) * o1, b1 = larger(beside - p.vb, 0.0f) * o2;
    const float c0 = larger(beside + p.vc, 0.0f) * o3, c1 = larger(beside - p.vc, 0.0f) * o4;
    const float far = larger(p.i + sign * r.straight * p.va, 0.0f) * o0;
    return (passed){far, (b0 + b1) + (c0 + c1), b0 - b1, c0 - c1};
}

/// The surroundings of cells of a row, in one channel. By direction of travel: +x, −x, +y, −y, +z,
/// −z. Light that arrives by +x was at x − 1, and leaves by +x through the low face of x + 1.
typedef struct row_work {
    uint32_t count;              // of cells
    size_t light_step, sum_step; // floats from a row to the next one
    alpi_lpv_scheme scheme;
    const float *own, *from[DIRECTIONS]; // light: term 0 of the first cell
    const face_shares *shares;
    const float *albedo[DIRECTIONS]; // of the faces that light leaves by
} row_work;

/// Light that arrives in a cell by direction d. a, b, c: the terms of its axis and of the two
/// others.
ALWAYS_INLINE passed arrive(const row_work *w, reading r, uint32_t x, bool blocked, int d, size_t a,
                            size_t b, size_t c)
{
    const float sign = d % 2 == 0 ? 1.0f : -1.0f;
    const size_t s = w->light_step;
    const float *p = w->from[d] + x;
    const cell_light light = {p[0], p[a * s], p[b * s], p[c * s]};
    if (!blocked) {
        return send(r, sign, light, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f);
    }
    const float(*o)[SHARE_STEP] = w->shares->at[entered(d)][d % 2];
    const uint32_t f = d == 1 ? x + 1 : x;
    return send(r, sign, light, o[0][f], o[1][f], o[2][f], o[3][f], o[4][f]);
}

/// Flux that blockers reflect of the light that leaves a cell by direction d.
ALWAYS_INLINE float reflected(const row_work *w, reading r, uint32_t x, int d, size_t a, size_t b,
                              size_t c)
{
    const float sign = d % 2 == 0 ? 1.0f : -1.0f;
    const size_t s = w->light_step;
    const float *p = w->own + x;
    const cell_light light = {p[0], p[a * s], p[b * s], p[c * s]};
    const float(*o)[SHARE_STEP] = w->shares->at[left(d)][d % 2];
    const uint32_t f = d == 0 ? x + 1 : x;
    const passed met = send(r, sign, light, 1.0f - o[0][f], 1.0f - o[1][f], 1.0f - o[2][f],
                            1.0f - o[3][f], 1.0f - o[4][f]);
    return w->albedo[d][x] * (FAR * met.far + SIDE * met.sides);
}

/// One channel of cells of a row. Each face's flux Φ becomes a lobe Φ/π (1/4 + n·ω/2), and
/// reflected flux becomes a lobe against the way that it went. Called with constants for each kind
/// of step.
/// @param next row 0 of the light of the next step   @param sum row 0 of the sum
ALWAYS_INLINE void gather_row(const row_work *w, bool blocked, bool reflects, float *next,
                              float *sum)
{
    const uint32_t n = w->count;
    const reading r = reading_of(&w->scheme);
    const float aside = w->scheme.aside;
    const float quarter = 0.0795774715f, half = 0.1591549431f; // 1/4π, 1/2π
    const float give_far = half * FAR, give_along = half * SIDE * w->scheme.give_along;
    const float give_aside = half * SIDE * w->scheme.give_aside;
    float *next_x = next + w->light_step, *next_y = next_x + w->light_step;
    float *next_z = next_y + w->light_step, *sum_x = sum + w->sum_step;
    float *sum_y = sum_x + w->sum_step, *sum_z = sum_y + w->sum_step;
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
            const float rx0 = reflected(w, r, x, 0, 1, 2, 3), rx1 = reflected(w, r, x, 1, 1, 2, 3);
            const float ry0 = reflected(w, r, x, 2, 2, 3, 1), ry1 = reflected(w, r, x, 3, 2, 3, 1);
            const float rz0 = reflected(w, r, x, 4, 3, 1, 2), rz1 = reflected(w, r, x, 5, 3, 1, 2);
            i += quarter * ((rx0 + rx1) + (ry0 + ry1) + (rz0 + rz1));
            vx += half * (rx1 - rx0);
            vy += half * (ry1 - ry0);
            vz += half * (rz1 - rz0);
        }
        sum[x] += i;
        sum_x[x] += vx;
        sum_y[x] += vy;
        sum_z[x] += vz;
        vx *= aside;
        vy *= aside;
        vz *= aside;
        const float scale = scale_of(r, i, vx, vy, vz);
        next[x] = scale * i;
        next_x[x] = scale * vx;
        next_y[x] = scale * vy;
        next_z[x] = scale * vz;
    }
}

typedef void gather_fn(const row_work *w, float *next, float *sum);

APART void gather_free(const row_work *w, float *next, float *sum)
{
    gather_row(w, false, false, next, sum);
}

APART void gather_blocked(const row_work *w, float *next, float *sum)
{
    gather_row(w, true, false, next, sum);
}

APART void gather_reflected(const row_work *w, float *next, float *sum)
{
    gather_row(w, true, true, next, sum);
}

// --- rows and their neighbours -------------------------------------------------------------------

static const float dark[ALPI_LPV_ROWS * (ALPI_LPV_SIDE_MOST + 2)]; // light beyond the grid

/// Light of the cells at (y, z): row 0 at x = −1.
static const float *light_at(const alpi_lpv_grid *g, int64_t y, int64_t z, bool wraps)
{
    const int64_t ny = g->size[1], nz = g->size[2];
    if (y < 0 || z < 0 || y >= ny || z >= nz) {
        if (!wraps) {
            return dark;
        }
        y = (y + ny) % ny;
        z = (z + nz) % nz;
    }
    return g->light + ((size_t)z * (size_t)ny + (size_t)y) * ALPI_LPV_ROWS * (g->size[0] + 2);
}

/// Ends of rows, where light that leaves on one side enters on the other.
static void wrap(float *rows, size_t step, uint32_t n)
{
    for (size_t t = 0; t < TERMS; t++) {
        rows[t * step] = rows[t * step + n];
        rows[t * step + n + 1] = rows[t * step + 1];
    }
}

/// Loads `count` floats of each of some rows into the cache, ahead of their use.
static void fetch(const float *from, size_t rows, size_t step, uint32_t count)
{
    enum { LINE = 16 };
    for (size_t row = 0; row < rows; row++) {
        for (uint32_t x = 0; x < count; x += LINE) {
            __builtin_prefetch(from + row * step + x);
        }
    }
}

/// Loads a third of what the next row is the first to read: one channel, and faces across one axis.
/// The processor's own prefetching does not follow so many rows.
static void fetch_third(const alpi_lpv_grid *g, uint32_t row, uint32_t first, uint32_t count,
                        size_t third)
{
    const size_t n = g->size[0], wide = n + 2, next = (size_t)row + 1;
    const size_t all = (size_t)g->size[1] * g->size[2], above = next + g->size[1];
    if (next < all) {
        const size_t at = next * ALPI_LPV_ROWS + third * TERMS;
        fetch(g->sum + at * n + first, TERMS, n, count);
        fetch(g->next + at * wide + first, TERMS, wide, count);
    }
    if (above < all) {
        const size_t at = above * ALPI_LPV_ROWS + third * TERMS;
        fetch(g->light + at * wide + first, TERMS, wide, count);
    }
    const uint32_t y = row % g->size[1], z = row / g->size[1];
    const float *faces = faces_at(g, third == 1 ? y + 2 : y + 1, third == 2 ? z + 1 : z, third);
    fetch(faces + first, AXIS_ROWS, n + 1, count);
}

/// Cells [first, first + count) of a row, all channels.
static void step_cells(const alpi_lpv_grid *g, const alpi_lpv_step *step, uint32_t row,
                       uint32_t first, uint32_t count)
{
    const uint32_t y = row % g->size[1], z = row / g->size[1];
    const float *own = light_at(g, y, z, false) + first;
    const float *from[DIRECTIONS] = {own,
                                     own + 2,
                                     light_at(g, (int64_t)y - 1, z, step->wraps) + first + 1,
                                     light_at(g, (int64_t)y + 1, z, step->wraps) + first + 1,
                                     light_at(g, y, (int64_t)z - 1, step->wraps) + first + 1,
                                     light_at(g, y, (int64_t)z + 1, step->wraps) + first + 1};
    const float *albedo[DIRECTIONS] = {NULL};
    gather_fn *gather = step->reflects  ? gather_reflected
                        : step->blocked ? gather_blocked
                                        : gather_free;
    face_shares shares;
    row_work w = {.count = count,
                  .light_step = g->size[0] + 2,
                  .sum_step = g->size[0],
                  .scheme = step->scheme,
                  .shares = &shares};
    if (step->blocked) {
        find_shares(g, step, y, z, first, count, &shares, albedo);
    }
    for (size_t channel = 0; channel < 3; channel++) {
        const size_t rows = channel * TERMS;
        float *next = g->next + (own + 1 - g->light) + rows * w.light_step;
        float *sum = g->sum + ((size_t)row * ALPI_LPV_ROWS + rows) * w.sum_step + first;
        w.own = own + 1 + rows * w.light_step;
        for (int d = 0; d < DIRECTIONS; d++) {
            w.from[d] = from[d] + rows * w.light_step;
            w.albedo[d] = step->blocked ? albedo[d] + channel * (g->size[0] + 1) : NULL;
        }
        if (step->blocked) {
            fetch_third(g, row, first, count, channel);
        }
        gather(&w, next, sum);
    }
}

static void step_rows(const alpi_lpv_grid *g, const alpi_lpv_step *step, uint32_t first,
                      uint32_t end)
{
    const uint32_t n = g->size[0];
    for (uint32_t row = first; row < end; row++) {
        for (uint32_t x = 0; x < n; x += SHARE_CELLS) {
            step_cells(g, step, row, x, n - x < SHARE_CELLS ? n - x : SHARE_CELLS);
        }
        for (size_t channel = 0; step->wraps && channel < 3; channel++) {
            wrap(g->next + ((size_t)row * ALPI_LPV_ROWS + channel * TERMS) * (n + 2), n + 2, n);
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
        const size_t at = (size_t)block * TERMS * n, wide = n + 2;
        const float *p0 = g->injected + at, *p1 = p0 + n, *p2 = p1 + n, *p3 = p2 + n;
        float *light = g->light + (size_t)block * TERMS * wide;
        float *l0 = light + 1, *l1 = l0 + wide, *l2 = l1 + wide, *l3 = l2 + wide;
        memcpy(g->sum + at, p0, (size_t)TERMS * n * sizeof *p0);
        EACH_CELL
        {
            const float vx = aside * p1[x], vy = aside * p2[x], vz = aside * p3[x];
            const float scale = scale_of(r, p0[x], vx, vy, vz);
            l0[x] = scale * p0[x];
            l1[x] = scale * vx;
            l2[x] = scale * vy;
            l3[x] = scale * vz;
        }
        if (step->wraps) {
            wrap(light, wide, n);
        }
    }
}

const alpi_lpv_loops ALPI_VARIANT(alpi_lpv_loops) = {fill_faces, start_rows, step_rows};
