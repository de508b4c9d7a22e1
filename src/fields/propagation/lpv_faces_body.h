// SPDX-License-Identifier: MIT
// Blockers as a step meets them: opacity of faces from their nodes, once a run, and the shares of
// light that pass them, once a step for all channels. Part of lpv_step_body.h.
#include "fields/propagation/lpv_grid.h"

#include <math.h>

#ifdef __clang__
#define EACH_CELL for (uint32_t x = 0; x < n; x++)
#else
#define EACH_CELL _Pragma("GCC ivdep") for (uint32_t x = 0; x < n; x++)
#endif
/// For functions that are called with constants.
#define ALWAYS_INLINE __attribute__((always_inline)) static inline
/// For loops with many values at a time, so that these lie close together on the stack.
#define APART __attribute__((noinline)) static

enum {
    TERMS = ALPI_LPV_TERMS,
    FACES = ALPI_LPV_FACES,
    DIRECTIONS = ALPI_LPV_DIRECTIONS,
    AXIS_ROWS = ALPI_LPV_AXIS_ROWS,
    SHARE_CELLS = 64,             // cells of a row whose shares are held at a time
    SHARE_STEP = SHARE_CELLS + 8, // a face more than cells, in whole vectors
};

static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

// --- opacity -------------------------------------------------------------------------------------

/// Opacity of the four nodes of a face from which more makes no difference. Its squares are finite.
static const float AREA_MOST = 4096.0f;

/// Low faces of the cells at (y, z) across an axis: the first row at x = 0.
static float *faces_at(const alpi_lpv_grid *g, size_t y, size_t z, size_t axis)
{
    const size_t wide = (size_t)g->size[0] + 1, high = (size_t)g->size[1] + 1;
    return g->faces + ((z * high + y) * 3 + axis) * AXIS_ROWS * wide;
}

/// Low faces of a row across one axis, each from the mean of its four nodes.
static void fill_axis(const alpi_lpv_grid *g, const alpi_lpv_scheme *s, uint32_t y, uint32_t z,
                      size_t axis)
{
    enum { N = ALPI_LPV_NODE_TERMS };
    const size_t wide = (size_t)g->size[0] + 1, high = (size_t)g->size[1] + 1;
    const size_t steps[3] = {N, N * wide, N * wide * high};
    const size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    const uint32_t at[3] = {0, y, z};
    const float *first = g->nodes + (z * high + y) * wide * N;
    float *rows = faces_at(g, y, z, axis);
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
        const float limit = sum[0] > AREA_MOST ? AREA_MOST / sum[0] : 1.0f;
        const float k = (s->by_angle ? 0.5f : 0.25f) * s->opacity * limit;
        const float ba = k * sum[1 + axis], bb = k * sum[1 + b], bc = k * sum[1 + c];
        // Surfaces of one orientation stop A n·ω, and the rest stops half of all.
        const float rest = s->opacity * limit * sum[0] - sqrtf(ba * ba + bb * bb + bc * bc);
        rows[x] = s->by_angle ? larger(0.5f * rest, 0.0f) : k * sum[0];
        rows[wide + x] = ba;
        rows[2 * wide + x] = bb;
        rows[3 * wide + x] = bc;
        for (size_t i = 0; i < 3; i++) {
            rows[(TERMS + i) * wide + x] = sum[0] > 0.0f ? sum[TERMS + i] / sum[0] : 0.0f;
        }
    }
}

static void fill_faces(const alpi_lpv_grid *g, const alpi_lpv_step *step, uint32_t first,
                       uint32_t end)
{
    const uint32_t high = g->size[1] + 1;
    for (uint32_t row = first; row < end; row++) {
        for (size_t axis = 0; axis < 3; axis++) {
            fill_axis(g, &step->scheme, row % high, row / high, axis);
        }
    }
}

// --- shares that pass ----------------------------------------------------------------------------

/// Shares of light that pass the faces round some cells of a row: those across x, of which there is
/// one more than cells, the low and high ones across y, and those across z. Each for light that
/// travels by + and by −.
typedef struct face_shares {
    float at[5][2][FACES][SHARE_STEP];
} face_shares;

/// Place in face_shares of the faces by which light of direction d enters cells. Across x the high
/// face of a cell is the low one of the next.
ALWAYS_INLINE int entered(int d)
{
    return d < 2 ? 0 : d - 1;
}

/// The same for light that leaves.
ALWAYS_INLINE int left(int d)
{
    return d < 2 ? 0 : (d ^ 1) - 1;
}

static inline float clamp_open(float open)
{
    return open < 0.0f ? 0.0f : (open > 1.0f ? 1.0f : open);
}

/// Shares of light that pass faces and travel on to the far face, and to the sides at + and − of
/// the other two axes. A surface stops light that travels against its normal: 1 − B(−ω).
/// @param sign of travel   @param rows opacity of the first of n faces, `wide` from row to row
static void share_faces(const alpi_lpv_scheme *s, float sign, uint32_t n, const float *rows,
                        size_t wide, float open[FACES][SHARE_STEP])
{
    const float *b0 = rows, *ba = b0 + wide, *bb = ba + wide, *bc = bb + wide;
    const float along = sign * s->along, aside = s->aside;
    EACH_CELL
    {
        const float all = 1.0f - b0[x], beside = all + along * ba[x];
        const float b = aside * bb[x], c = aside * bc[x];
        open[0][x] = clamp_open(all + sign * ba[x]);
        open[1][x] = clamp_open(beside + b);
        open[2][x] = clamp_open(beside - b);
        open[3][x] = clamp_open(beside + c);
        open[4][x] = clamp_open(beside - c);
    }
}

/// Shares for `count` cells from `first` of the row at (y, z), and the albedo of the faces that
/// light leaves by. Shares that the step does not read are left as they are.
static void find_shares(const alpi_lpv_grid *g, const alpi_lpv_step *step, uint32_t y, uint32_t z,
                        uint32_t first, uint32_t count, face_shares *shares,
                        const float *albedo[DIRECTIONS])
{
    const size_t wide = (size_t)g->size[0] + 1;
    const float *rows[5] = {faces_at(g, y, z, 0), faces_at(g, y, z, 1), faces_at(g, y + 1, z, 1),
                            faces_at(g, y, z, 2), faces_at(g, y, z + 1, 2)};
    for (size_t i = 0; i < 5; i++) {
        const bool low = i % 2 == 1, all = i == 0 || step->reflects;
        const uint32_t faces = i == 0 ? count + 1 : count;
        if (all || low) {
            share_faces(&step->scheme, 1.0f, faces, rows[i] + first, wide, shares->at[i][0]);
        }
        if (all || !low) {
            share_faces(&step->scheme, -1.0f, faces, rows[i] + first, wide, shares->at[i][1]);
        }
    }
    for (int d = 0; d < DIRECTIONS; d++) {
        albedo[d] = rows[left(d)] + TERMS * wide + first + (d == 0 ? 1 : 0);
    }
}
