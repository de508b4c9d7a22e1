// SPDX-License-Identifier: MIT
// Which triangle of one scene is which of another.
#ifndef ALPI_REPORT_SAME_TRIANGLES_H
#define ALPI_REPORT_SAME_TRIANGLES_H

#include "scene/scene.h"

/// For each triangle of the first scene its number in the second, and by how many places the
/// corners are turned: corner k of the first is corner (k + turn) mod 3 of the second.
typedef struct alpi_same_triangles {
    uint32_t *numbers; // [triangles of the first]; nothing is said of unusable ones
    uint8_t *turns;
} alpi_same_triangles;

/// @return ALP_OK; INVALID_DATA (they are not the same: the message names one); OUT_OF_MEMORY. To
///         be released in each case
alp_result alpi_same_triangles_find(const alp_scene *a, const alp_scene *b,
                                    alpi_same_triangles *same);
void alpi_same_triangles_release(alp_context *context, alpi_same_triangles *same);

#endif
