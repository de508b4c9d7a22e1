// SPDX-License-Identifier: MIT
// Surfaces that get more texels per metre than others, or fewer.
#ifndef ALPI_ATLAS_FACTORS_H
#define ALPI_ATLAS_FACTORS_H

#include "atlas/stages.h"

/// The factor of each surface by alp_atlas_options.densities.
/// @param factors out: [surface_count], released by the caller; NULL when densities is
/// @return ALP_OK; INVALID_ARGUMENT: an entry that says nothing or matches nothing, factors
///   of one surface that multiply to less or more than one factor may be; OUT_OF_MEMORY
alp_result alpi_factors_create(const alp_scene *scene, const char *densities, float **factors);

/// Triangles of surfaces with unlike factors are no neighbours, so that no chart holds both.
void alpi_factors_part(const alp_scene *scene, const float *factors, uint32_t (*neighbours)[3]);

/// Charts as they come from projection, all of one factor each, grow by it.
void alpi_factors_apply(alp_atlas *atlas, alpi_charts *charts);

/// Of a triangle's surface.
double alpi_factor_of(const alp_atlas *atlas, uint32_t triangle);

#endif
