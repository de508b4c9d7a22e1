// SPDX-License-Identifier: MIT
// Whether triangles of a plane overlap: how a chart is kept from folding over itself.
#ifndef ALPI_ATLAS_FOLD_H
#define ALPI_ATLAS_FOLD_H

#include "base/context.h"

#include <stdbool.h>

/// A triangle in the plane, counter-clockwise.
typedef struct alpi_flat {
    double x[3], y[3];
} alpi_flat;

/// Whether the insides of a and b overlap by more than `tolerance` in every direction. Triangles
/// that share an edge or a vertex do not.
bool alpi_flat_overlap(const alpi_flat *a, const alpi_flat *b, double tolerance);

/// A grid over triangles of a plane, each listed in the cells it may touch. Zero it, build it as
/// often as wanted (buffers are kept), destroy it.
typedef struct alpi_fold {
    alp_context *context;
    const alpi_flat *triangles; // borrowed
    uint32_t count;
    double low_x, low_y, cell, tolerance;
    uint32_t columns, rows;
    uint32_t *first; // [columns·rows + 1] into items
    uint32_t *items;
    size_t first_capacity, item_capacity;
} alpi_fold;
alp_result alpi_fold_build(alpi_fold *fold, const alpi_flat *triangles, uint32_t count);
/// Whether `triangle` overlaps any other one that is marked.
bool alpi_fold_overlaps(const alpi_fold *fold, uint32_t triangle, const bool *marked);
void alpi_fold_destroy(alpi_fold *fold);

#endif
