// SPDX-License-Identifier: MIT
// One grid of a light propagation volume, and one step of light through it.
//
// A cell holds an intensity, I(ω) = p0 + p·ω [W/sr] for each channel: two bands of spherical
// harmonics with their constants folded in. A cosine lobe of flux Φ about n is Φ/π (1/4 + n·ω/2),
// and all flux of a cell is 4π p0.
//
// A step takes light from each cell to its six neighbours. Seen from the centre of a cell, the
// neighbour along axis d has five faces: the far one and four at its sides. Each takes the flux
//
//     Φ = Δω max(0, I(ω_face)) (1 − B(−ω_face)),     Δω the solid angle of the face
//
// and gives it to the neighbour as a cosine lobe. Clamping at 0 adds light behind lobes, so each
// cell's 30 fluxes are scaled to have the sum 4π p0. With that a step keeps all light.
//
// Surfaces are held by another grid, whose nodes lie at the corners of cells. A node holds the
// opacity B(ω) = Σ A/s² (1/4 + n·ω/2) of the surfaces round it: a surface of normal n stops light
// that travels against n. The four nodes of a face are averaged for light that passes there. From
// the same terms ACCURATE reads v = Σ A/s² n and B(ω) = v·ω + (Σ A/s² − |v|)/2, which is exact for
// surfaces of one orientation and stops no light that passes along them.
#ifndef ALPI_FIELDS_LPV_GRID_H
#define ALPI_FIELDS_LPV_GRID_H

#include "base/context.h"

#include <alpenglow/lpv.h>
#include <alpenglow/shared_constants.h>

enum {
    ALPI_LPV_SIDE_MOST = 512,
    ALPI_LPV_CASCADES_MOST = 8,
    ALPI_LPV_POINTS_MOST = 1 << 24,           // that block
    ALPI_LPV_TERMS = 4,                       // p0, px, py, pz
    ALPI_LPV_ROWS = 3 * ALPI_LPV_TERMS,       // of light in a cell, by channel
    ALPI_LPV_DIRECTIONS = 6,                  // of travel: +x, −x, +y, −y, +z, −z
    ALPI_LPV_FACES = 5,                       // of a neighbour: the far one, four sides
    ALPI_LPV_AXIS_ROWS = ALPI_LPV_TERMS + 3,  // of faces across an axis: opacity, and albedo
    ALPI_LPV_NODE_TERMS = ALPI_LPV_TERMS + 3, // opacity, and albedo × opacity
};

/// How light is read at faces and given on: all that tells the modes apart. Cosines are along the
/// way to the neighbour, and from its axis to a side.
typedef struct alpi_lpv_scheme {
    float far;                    // length of the direction in which the far face is read
    float along, aside;           // direction in which a side face is read
    float give_along, give_aside; // direction of the lobe that light through a side face becomes
    float opacity;                // factor on blockers
    bool by_angle; // blockers of one orientation stop light by its angle, not by two bands
} alpi_lpv_scheme;
alpi_lpv_scheme alpi_lpv_scheme_of(alp_lpv_mode mode);

typedef struct alpi_lpv_grid {
    uint32_t size[3];
    double cell;           // metres
    int64_t corner[3];     // of cell 0, 0, 0, in cells from the origin
    int64_t sum_corner[3]; // the same when `sum` was made
    float *injected, *sum; // [z][y][channel × 4 + term][x]; `sum` is what readers see
    // [z][y][channel × 4 + term][x + 2], a cell more at both ends: what travels next. It is scaled
    // for the step, and p × the cosine `aside`.
    float *light, *next;
    // [z + 1][y + 1][axis][AXIS_ROWS][x + 1] of low faces: their opacity as a number and three
    // terms, along the axis and the two after it; then their albedo by channel
    float *faces;
    // [z + 1][y + 1][x + 1][NODE_TERMS]: merged views, and the view that is being added
    float *nodes, *view;
    int64_t node_corner[3]; // `corner` when the nodes were filled
} alpi_lpv_grid;

static inline size_t alpi_lpv_cells(const uint32_t size[3])
{
    return (size_t)size[0] * size[1] * size[2];
}

static inline size_t alpi_lpv_nodes(const uint32_t size[3])
{
    return ((size_t)size[0] + 1) * ((size_t)size[1] + 1) * ((size_t)size[2] + 1);
}

/// Cells with one more at both ends of each row.
static inline size_t alpi_lpv_wide_cells(const uint32_t size[3])
{
    return ((size_t)size[0] + 2) * size[1] * size[2];
}

/// The kind of a step. `wraps`: light that leaves on one side enters on the other (tests).
typedef struct alpi_lpv_step {
    alpi_lpv_scheme scheme;
    bool blocked, reflects, wraps;
} alpi_lpv_step;

/// Works on rows [first, end), counted y + z × rows along y.
typedef void alpi_lpv_rows_fn(const alpi_lpv_grid *grid, const alpi_lpv_step *step, uint32_t first,
                              uint32_t end);
typedef struct alpi_lpv_loops {
    alpi_lpv_rows_fn *faces; // nodes to `faces`, (size[1] + 1)(size[2] + 1) rows
    alpi_lpv_rows_fn *start; // `injected` to `light`, and to `sum`
    alpi_lpv_rows_fn *step;  // light of neighbours to `next`, and into `sum`
} alpi_lpv_loops;
extern const alpi_lpv_loops alpi_lpv_loops_baseline, alpi_lpv_loops_v3;

#endif
