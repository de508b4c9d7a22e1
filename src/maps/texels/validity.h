// SPDX-License-Identifier: MIT
// Texels partly or completely inside other geometry, and lifted points that would be.
#ifndef ALPI_MAPS_VALIDITY_H
#define ALPI_MAPS_VALIDITY_H

#include "maps/texels/proximity.h"
#include "maps/texels/scratch.h"

/// Surroundings of texels, found by short rays.
typedef struct alpi_validity {
    alp_context *context;
    uint8_t *proximity;    // [texels] alpi_proximity
    uint8_t *dropped;      // [texels] 1: completely inside a solid and beside a texel that is not,
                           // whose value it takes
    alpi_scratch *scratch; // borrowed
    uint64_t rays, moved_count, dropped_count, lowered_count; // of the last call
} alpi_validity;

/// Allocates the arrays for the texels of an atlas.
/// @param scratch [texels] borrowed; zero for the texels of alpi_validity_find before and after it
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_validity_open(alp_context *context, uint32_t texels, alpi_scratch *scratch,
                              alpi_validity *validity);

/// Finds for the texels in `order`:
/// - proximity.
/// - flag NO_LIFT: a lifted point would pass through a surface, so points stay on their triangle.
/// - texels->valid, for texels near another surface: without those of 16 strata that lie inside
///   other geometry (inside.h).
/// - dropped.
/// - flag HIDDEN: completely inside a solid, and beside no texel that is seen; or inside and
///   touching a surface, with nothing beside it.
/// Nothing is written for other texels.
/// @param setup of the bake; its tracer and scene   @param receivers of `texels`
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_validity_find(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              alpi_texels *texels, const alpi_lattice *lattice,
                              const uint32_t *order, uint32_t order_count,
                              const alpi_task_progress *progress, alpi_validity *validity);
/// Opens, with scratch of its own, and finds all, for callers that need it once.
alp_result alpi_validity_create(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                                alpi_texels *texels, const alpi_lattice *lattice,
                                const uint32_t *order, uint32_t order_count,
                                const alpi_task_progress *progress, alpi_validity *validity);
void alpi_validity_destroy(alpi_validity *validity);

#endif
