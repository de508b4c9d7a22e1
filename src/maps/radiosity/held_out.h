// SPDX-License-Identifier: MIT
// Held-out texels: interpolated, and also traced by independent rays. Their differences measure the
// error of interpolation, which no repetition of the same rays would reveal.
#ifndef ALPI_MAPS_HELD_OUT_H
#define ALPI_MAPS_HELD_OUT_H

#include "transport/paths/reference.h"

enum { ALPI_HELD_OUT = 1024 };

/// The first of several maps of the same light chooses its held-out texels, evenly and at random
/// among those that it interpolates. Every map traces them.
typedef struct alpi_held_out {
    uint32_t count; // 0: none yet
    uint32_t texels[ALPI_HELD_OUT];
    alpi_reference_value values[ALPI_HELD_OUT]; // by the independent rays of the last map
} alpi_held_out;

/// Mean square error of texels by channel, compared with independent values y of known variance:
/// E[(x − y)²] − Var y = E[(x − truth)²], at least 0.
void alpi_held_out_error(const uint32_t *texels, const alpi_reference_value *found, uint32_t count,
                         const alpi_reference_value *values, float variance[3]);

#endif
