// SPDX-License-Identifier: MIT
// Texels that lie inside other geometry, in part or wholly, and points that a lift would put there.
#ifndef ALPI_MAPS_VALIDITY_H
#define ALPI_MAPS_VALIDITY_H

#include "maps/texels/lattice.h"
#include "maps/texels/scratch.h"
#include "transport/occlusion/occlusion.h"

/// How far another surface is from a texel.
typedef enum alpi_proximity {
    ALPI_FAR = 0,
    ALPI_NEAR,    // some texels: interpolate with care
    ALPI_TOUCHING // about one: occlusion may change within a texel
} alpi_proximity;

/// What a few short rays found around the texels.
typedef struct alpi_validity {
    alp_context *context;
    uint8_t *proximity; // [texels] alpi_proximity
    uint8_t *dropped;   // [texels] 1: wholly inside other geometry and beside one that is not: its
                        // value must come from there
    alpi_scratch *scratch;                                    // borrowed
    uint64_t rays, moved_count, dropped_count, lowered_count; // of the last look
} alpi_validity;

/// Arrays for the texels of an atlas, to look around parts of them one after the other.
/// @param scratch [texels] borrowed; zero for the texels of a look before it, and after
alp_result alpi_validity_open(alp_context *context, uint32_t texels, alpi_scratch *scratch,
                              alpi_validity *validity);

/// Looks around every texel of `order`:
/// - lifted points that the lift carries through a surface stay on their triangle (flag NO_LIFT);
/// - of texels near another surface, each of 16 strata is inside when one of four tangent rays of a
///   texel's length meets a back face first, or three of four rays upwards do; texels->valid leaves
///   those strata out. Back faces of double-sided materials and of panes (glass, BLEND) are no sign
///   of an inside: light gets in. Where solids reach into each other, surfaces are counted: more
///   backs than fronts on the way out in three directions of four;
/// - texels wholly inside that no filter reads with one that is seen get the flag HIDDEN: those
///   judged so, and those that touch something with nothing beside them.
/// @param setup  of the bake; its tracer and random numbers   @param receivers of `texels`
/// What it finds is written for those texels alone, and takes time for them alone.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_validity_look(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              alpi_texels *texels, const alpi_lattice *lattice,
                              const uint32_t *order, uint32_t order_count,
                              const alpi_task_progress *progress, alpi_validity *validity);
/// Both, with scratch of its own, for all texels that are ever looked at.
alp_result alpi_validity_create(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                                alpi_texels *texels, const alpi_lattice *lattice,
                                const uint32_t *order, uint32_t order_count,
                                const alpi_task_progress *progress, alpi_validity *validity);
void alpi_validity_destroy(alpi_validity *validity);

#endif
