// SPDX-License-Identifier: MIT
// What the samples of direct light at a receiver come to.
#ifndef ALPI_TRANSPORT_DIRECT_SUMS_H
#define ALPI_TRANSPORT_DIRECT_SUMS_H

#include "transport/direct/direct_polygons.h"
#include "transport/direct/direct_setup.h"

/// Adds the light of polygons, gathered as lane `lane` of eight receivers.
/// @param sums        [parts][replicates] over the samples
/// @param directional what their rays brought, as much of it as there is of the closed form; NULL:
///                    it was not asked for
void alpi_direct_add_polygons(const alpi_polygon_gather *polygons, uint32_t lane,
                              double (*sums)[ALPI_DIRECT_REPLICATES][3],
                              alpi_directional_sums *directional);

/// What the two halves of the samples of a receiver tell of its error. Between the replicates of a
/// half samples are stratified, so that the variance of a mean of replicates that know nothing of
/// each other, V = Σ (xᵢ − x̄)² / (R (R − 1)), is too large. With the means a, b of the halves,
/// which are independent, (a − b)² / 4 is not; but it is one number. So over all receivers of a
/// call V is scaled by F = Σ (a − b)² / 4 / Σ V: right on average, and of each as precise as V.
/// Few receivers do not tell, nor many of which few have all the noise: of those V partly stays,
/// which is too large.
typedef struct alpi_direct_halves {
    float (*sums)[2]; // [(count + 7) / 8] (a − b)² / 4 and V, over the channels and the receivers
                      // of a block
} alpi_direct_halves;

/// @param count of receivers listed  @return ALP_OK; OUT_OF_MEMORY. Release on failure too
alp_result alpi_direct_halves_create(const alpi_direct *direct, uint32_t count,
                                     alpi_direct_halves *halves);
void alpi_direct_halves_release(const alpi_direct *direct, alpi_direct_halves *halves);

/// Means, and what the halves tell. That of all is the floats of the parts added up; its variance,
/// of the replicates of all.
/// @param polygons NULL, or those gathered as lane `lane`: parts that repeat a half tell nothing
/// @param told     of the block: added to
void alpi_direct_put(const alpi_direct *direct, const double (*sums)[ALPI_DIRECT_REPLICATES][3],
                     uint32_t receiver, const alpi_polygon_gather *polygons, uint32_t lane,
                     float told[2], alpi_direct_output *output);

/// Scales the variances of all and of parts.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_direct_scale_variances(const alpi_direct *direct, const uint32_t *list,
                                       uint32_t count, const alpi_direct_halves *halves,
                                       alpi_direct_output *output);

#endif
