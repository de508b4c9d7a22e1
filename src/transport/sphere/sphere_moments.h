// SPDX-License-Identifier: MIT
// Distances that the rays of a point meet, as two moments by octahedral texel.
//
// A texel near the edge of a close surface, or one that meets it at a grazing angle, has rays that
// go past it. Their long distances would raise mean and variance until the surface hides nothing.
// So distances beyond twice the texel's median count as that. A lower limit leaks less light, but
// it hides visible surfaces at grazing angles, which shows as specks.
#ifndef ALPI_TRANSPORT_SPHERE_MOMENTS_H
#define ALPI_TRANSPORT_SPHERE_MOMENTS_H

#include "transport/sphere/sphere_rays.h"

/// Sums by texel and bin: weight, and weight times the distance and its square.
typedef struct alpi_sphere_moments {
    double sums[ALPI_SPHERE_MOMENTS][ALPI_MOMENT_BINS][3];
} alpi_sphere_moments;

void alpi_sphere_moments_add(const alpi_sphere_loops *loops, const alpi_sphere_packet *packets,
                             const alpi_hits *hits, uint32_t count, float reach,
                             alpi_sphere_moments *moments);

/// @param found [ALPI_SPHERE_MOMENTS] out: mean distance [m], and of its square [m²]
void alpi_sphere_moments_finish(const alpi_sphere_moments *moments, float reach, float (*found)[2]);

#endif
