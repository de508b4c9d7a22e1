// SPDX-License-Identifier: MIT
// Pairs of triangles that may lie in one place and one plane, facing the same way: whose boxes and
// normals are the same within rounding.
#ifndef ALPI_DOCTOR_DOCTOR_PAIRS_H
#define ALPI_DOCTOR_DOCTOR_PAIRS_H

#include "doctor/doctor.h"

#include <math.h>

/// How far vertices that are meant to lie in one plane may be from it: of the largest coordinate,
/// four float steps. Matrices and files that were written in floats move them by one or two.
static inline double alpi_doctor_rounding(const vec3 c[3])
{
    float largest = 0.0f;
    for (int k = 0; k < 9; k++) { // of finite numbers; fmaxf is a call
        const float side = fabsf(k % 3 == 0 ? c[k / 3].x : k % 3 == 1 ? c[k / 3].y : c[k / 3].z);
        largest = side > largest ? side : largest;
    }
    return 4.0 * 0x1p-23 * (double)largest;
}

/// Pairs that are visited, besides one leaf's, and looks for them: for each triangle, and the least
/// for them all. Of a plane of triangles there are six and some tens.
enum {
    ALPI_DOCTOR_PAIRS_EACH = 32,
    ALPI_DOCTOR_LOOKS_EACH = 512,
    ALPI_DOCTOR_PAIRS_LEAST = 1 << 22
};

/// Gets each pair once, lower triangle first; in an order that is always the same.
typedef alp_result alpi_doctor_pair_fn(void *user, uint32_t a, uint32_t b);

/// Visits the pairs of a scene. Triangles whose height is less than 64 times the rounding of their
/// coordinates face nowhere in particular, and are left out. Where very many lie in one place, the
/// search ends at its limits.
/// @param all out: whether every pair was visited, not as many as the limits allow
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED; what `each` says
/// Cost: about n log n; 92 to 116 bytes for each triangle.
alp_result alpi_doctor_visit_pairs(const alp_scene *scene, alpi_doctor_pair_fn *each, void *user,
                                   bool *all);

#endif
