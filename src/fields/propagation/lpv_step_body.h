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

enum { TERMS = ALPI_LPV_TERMS, FACES = ALPI_LPV_FACES, DIRECTIONS = ALPI_LPV_DIRECTIONS };
static const float FAR = (float)ALP_LPV_FAR, SIDE = (float)ALP_LPV_SIDE;
static const float PI4 = 12.56637061f;

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
static inline passed send(reading r, float sign, cell_light p, float o0, float o1, float o2,
                          float o3, float o4)
{
    const float beside = p.i + sign * r.along * p.va;
    const float b0 = larger(beside + p.vb, 0.0f) * o1, b1 = larger(beside - p.vb, 0.0f) * o2;
    const float c0 = larger(beside + p.vc, 0.0f) * o3, c1 = larger(beside - p.vc, 0.0f) * o4;
    const float far = larger(p.i + sign * r.straight * p.va, 0.0f) * o0;
    return (passed){far, (b0 + b1) + (c0 + c1), b0 - b1, c0 - c1};
}

/// The surroundings of a row of cells, in one channel. By direction of travel: +x, −x, +y, −y, +z,
/// −z. Light that arrives by +x was at x − 1, and leaves by +x through the low face of x + 1.
typedef struct row_work {
    uint32_t n;
    size_t light_step, open_step; // floats from a row to the next one
    alpi_lpv_scheme scheme;
    const float *own, *from[DIRECTIONS];               // light: term 0 at x = 0
    const float *open[DIRECTIONS], *leave[DIRECTIONS]; // shares that pass: face 0
    const float *albedo[DIRECTIONS];                   // of the faces that light leaves by
} row_work;

/// Light that arrives in a cell by direction d. a, b, c: the terms of its axis and of the two
/// others.
static inline passed arrive(const row_work *w, reading r, uint32_t x, bool blocked, int d, size_t a,
                            size_t b, size_t c)
{
    const float sign = d % 2 == 0 ? 1.0f : -1.0f;
    const size_t s = w->light_step, k = w->open_step;
    const float *p = w->from[d] + x, *o = blocked ? w->open[d] + x : NULL;
    const cell_light light = {p[0], p[a * s], p[b * s], p[c * s]};
    return send(r, sign, light, blocked ? o[0] : 1.0f, blocked ? o[k] : 1.0f,
                blocked ? o[2 * k] : 1.0f, blocked ? o[3 * k] : 1.0f, blocked ? o[4 * k] : 1.0f);
}

/// Flux that blockers throw back of the light that leaves a cell by direction d.
static inline float come_back(const row_work *w, reading r, uint32_t x, int d, size_t a, size_t b,
                              size_t c)
{
    const float sign = d % 2 == 0 ? 1.0f : -1.0f;
    const size_t s = w->light_step, k = w->open_step;
    const float *p = w->own + x, *o = w->leave[d] + x;
    const cell_light light = {p[0], p[a * s], p[b * s], p[c * s]};
    const passed met = send(r, sign, light, 1.0f - o[0], 1.0f - o[k], 1.0f - o[2 * k],
                            1.0f - o[3 * k], 1.0f - o[4 * k]);
    return w->albedo[d][x] * (FAR * met.far + SIDE * met.sides);
}

/// One channel of a row. Each face's flux Φ becomes a lobe Φ/π (1/4 + n·ω/2); what comes back, one
/// against the way that it went. Called with constants for each kind of step.
/// @param next row 0 of the light of the next step   @param sum row 0 of the sum
__attribute__((always_inline)) static inline void gather_row(const row_work *w, bool blocked,
                                                             bool reflects, float *next, float *sum)
{
    const uint32_t n = w->n;
    const reading r = reading_of(&w->scheme);
    const float aside = w->scheme.aside;
    const float quarter = 0.0795774715f, half = 0.1591549431f; // 1/4π, 1/2π
    const float give_far = half * FAR, give_along = half * SIDE * w->scheme.give_along;
    const float give_aside = half * SIDE * w->scheme.give_aside;
    float *next_x = next + w->light_step, *next_y = next_x + w->light_step;
    float *next_z = next_y + w->light_step, *sum_x = sum + n, *sum_y = sum_x + n,
          *sum_z = sum_y + n;
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

/// Openness of the low faces of the cells at (y, z): row 0 at x = 0.
static const float *open_at(const alpi_lpv_grid *g, size_t y, size_t z)
{
    return g->open + (z * (g->size[1] + 1) + y) * ALPI_LPV_OPEN_ROWS * (g->size[0] + 1);
}

/// Light that enters by the low face travels by +, and leaves by it by −.
static void find_faces(const alpi_lpv_grid *g, uint32_t y, uint32_t z, row_work *w,
                       const float *albedo[DIRECTIONS])
{
    const float *own = open_at(g, y, z);
    const float *beyond[3] = {own + 1, open_at(g, y + 1, z), open_at(g, y, z + 1)};
    for (size_t a = 0; a < 3; a++) {
        const size_t up = 2 * a, down = 2 * a + 1;
        const size_t colors = (DIRECTIONS * FACES + 3 * a) * w->open_step;
        w->open[up] = own + up * FACES * w->open_step;
        w->open[down] = beyond[a] + down * FACES * w->open_step;
        w->leave[up] = beyond[a] + up * FACES * w->open_step;
        w->leave[down] = own + down * FACES * w->open_step;
        albedo[up] = beyond[a] + colors;
        albedo[down] = own + colors;
    }
}

/// Ends of rows, where light that leaves on one side enters on the other.
static void wrap(float *rows, size_t step, uint32_t n)
{
    for (size_t t = 0; t < TERMS; t++) {
        rows[t * step] = rows[t * step + n];
        rows[t * step + n + 1] = rows[t * step + 1];
    }
}

static void step_rows(const alpi_lpv_grid *g, const alpi_lpv_step *step, uint32_t first,
                      uint32_t end)
{
    row_work w = {.n = g->size[0],
                  .light_step = g->size[0] + 2,
                  .open_step = g->size[0] + 1,
                  .scheme = step->scheme};
    for (uint32_t row = first; row < end; row++) {
        const uint32_t y = row % g->size[1], z = row / g->size[1];
        const float *own = light_at(g, y, z, false), *albedo[DIRECTIONS] = {NULL};
        const float *from[DIRECTIONS] = {own,
                                         own + 2,
                                         light_at(g, (int64_t)y - 1, z, step->wraps) + 1,
                                         light_at(g, (int64_t)y + 1, z, step->wraps) + 1,
                                         light_at(g, y, (int64_t)z - 1, step->wraps) + 1,
                                         light_at(g, y, (int64_t)z + 1, step->wraps) + 1};
        if (step->blocked) {
            find_faces(g, y, z, &w, albedo);
        }
        for (size_t channel = 0; channel < 3; channel++) {
            const size_t rows = channel * TERMS;
            float *next = g->next + (own - g->light) + rows * w.light_step;
            float *sum = g->sum + ((size_t)row * ALPI_LPV_ROWS + rows) * w.n;
            w.own = own + 1 + rows * w.light_step;
            for (int d = 0; d < DIRECTIONS; d++) {
                w.from[d] = from[d] + rows * w.light_step;
                w.albedo[d] = step->blocked ? albedo[d] + channel * w.open_step : NULL;
            }
            if (step->reflects) {
                gather_row(&w, true, true, next + 1, sum);
            } else if (step->blocked) {
                gather_row(&w, true, false, next + 1, sum);
            } else {
                gather_row(&w, false, false, next + 1, sum);
            }
            if (step->wraps) {
                wrap(next, w.light_step, w.n);
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

// --- what blocks light ---------------------------------------------------------------------------

static inline float clamp_open(float open)
{
    return open < 0.0f ? 0.0f : (open > 1.0f ? 1.0f : open);
}

/// Shares of light that pass a face and travel on to the far face, and to the sides at + and − of
/// the other two axes. A surface stops light that travels against its normal: 1 − B(−ω).
/// @param b0, ba, bb, bc opacity of the face: ba along the axis   @param sign of travel
static void open_faces(const alpi_lpv_scheme *s, float sign, float b0, float ba, float bb, float bc,
                       size_t step, float *open)
{
    const float beside = 1.0f - b0 + sign * s->along * ba;
    open[0] = clamp_open(1.0f - b0 + sign * ba);
    open[step] = clamp_open(beside + s->aside * bb);
    open[2 * step] = clamp_open(beside - s->aside * bb);
    open[3 * step] = clamp_open(beside + s->aside * bc);
    open[4 * step] = clamp_open(beside - s->aside * bc);
}

/// Low faces of a row across one axis, each from the mean of its four nodes.
static void open_row(const alpi_lpv_grid *g, const alpi_lpv_scheme *s, uint32_t y, uint32_t z,
                     size_t axis, float *rows)
{
    enum { N = ALPI_LPV_NODE_TERMS };
    const size_t wide = (size_t)g->size[0] + 1, high = (size_t)g->size[1] + 1;
    const size_t steps[3] = {N, N * wide, N * wide * high};
    const size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    const uint32_t at[3] = {0, y, z};
    const float *first = g->nodes + (z * high + y) * wide * N;
    float *up = rows + 2 * axis * FACES * wide, *down = up + FACES * wide;
    float *albedo = rows + (DIRECTIONS * FACES + 3 * axis) * wide;
    for (size_t x = 0; x < wide; x++) {
        const float *node = first + x * N;
        const size_t along[3] = {x, at[1], at[2]};
        // Faces beyond the last cell of another axis belong to no cell.
        const size_t to_b = along[b] < g->size[b] ? steps[b] : 0;
        const size_t to_c = along[c] < g->size[c] ? steps[c] : 0;
        float sum[N];
        for (size_t t = 0; t < N; t++) {
            sum[t] = node[t] + node[to_b + t] + node[to_c + t] + node[to_b + to_c + t];
        }
        const float k = (s->by_angle ? 0.5f : 0.25f) * s->opacity;
        const float ba = k * sum[1 + axis], bb = k * sum[1 + b], bc = k * sum[1 + c];
        // Surfaces of one orientation stop A n·ω, and the rest stops half of all.
        const float rest = s->opacity * sum[0] - sqrtf(ba * ba + bb * bb + bc * bc);
        const float b0 = s->by_angle ? larger(0.5f * rest, 0.0f) : k * sum[0];
        open_faces(s, 1.0f, b0, ba, bb, bc, wide, up + x);
        open_faces(s, -1.0f, b0, ba, bb, bc, wide, down + x);
        for (size_t i = 0; i < 3; i++) {
            albedo[i * wide + x] = sum[0] > 0.0f ? sum[TERMS + i] / sum[0] : 0.0f;
        }
    }
}

static void open_rows(const alpi_lpv_grid *g, const alpi_lpv_step *step, uint32_t first,
                      uint32_t end)
{
    const uint32_t high = g->size[1] + 1;
    for (uint32_t row = first; row < end; row++) {
        float *rows = g->open + (size_t)row * ALPI_LPV_OPEN_ROWS * (g->size[0] + 1);
        for (size_t axis = 0; axis < 3; axis++) {
            open_row(g, &step->scheme, row % high, row / high, axis, rows);
        }
    }
}

const alpi_lpv_loops ALPI_VARIANT(alpi_lpv_loops) = {open_rows, start_rows, step_rows};
