// SPDX-License-Identifier: MIT
// What the samples of direct light at a receiver come to.
#ifndef ALPI_TRANSPORT_DIRECT_SUMS_H
#define ALPI_TRANSPORT_DIRECT_SUMS_H

#include "transport/direct_polygons.h"
#include "transport/direct_setup.h"

/// Adds the light of polygons, gathered as lane `lane` of eight receivers.
/// @param sums        [parts][replicates] over the samples
/// @param directional what their rays brought, as much of it as there is of the closed form; NULL:
///                    it was not asked for
void alpi_direct_add_polygons(const alpi_polygon_gather *polygons, uint32_t lane,
                              double (*sums)[ALPI_DIRECT_REPLICATES][3],
                              alpi_directional_sums *directional);

/// Means. That of all is the floats of the parts added up; its variance, of the replicates of all.
void alpi_direct_put(const alpi_direct *direct, const double (*sums)[ALPI_DIRECT_REPLICATES][3],
                     uint32_t receiver, alpi_direct_output *output);

#endif
