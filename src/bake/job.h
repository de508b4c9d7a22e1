// SPDX-License-Identifier: MIT
// The job of one bake, shared by the files of this room.
#ifndef ALPI_BAKE_JOB_H
#define ALPI_BAKE_JOB_H

#include "maps/lightmap.h"
#include "transport/occlusion.h"

#include <alpenglow/bake.h>

typedef struct alpi_bake_job {
    const alp_scene *scene;
    alp_context *context;
    alp_bake_options options;
    alp_lightmap *lightmap;
    float (*bent)[3], (*obscurance)[3]; // [texels] while sampling; NULL: not asked for
    alp_bake_report report;
} alpi_bake_job;

/// Tells the user that a stage begins; false from the user cancels.
alp_result alpi_bake_begin_stage(const alpi_bake_job *job, const char *stage);

/// Occlusion at the texels of the lightmap, stored in it; fills the report.
alp_result alpi_bake_occlusion(alpi_bake_job *job);

/// Refuses maps that have no meaning together with the other options.
alp_result alpi_bake_check_maps(const alpi_bake_job *job);
/// Room for what the maps besides occlusion need while they are gathered, and its end.
alp_result alpi_bake_begin_side_maps(alpi_bake_job *job);
void alpi_bake_end_side_maps(alpi_bake_job *job);
/// Coloured obscurance of the texels in `order`, if it was asked for; `samples` rays each.
alp_result alpi_bake_obscurance(alpi_bake_job *job, const alpi_occlusion_setup *setup,
                                const alpi_receivers *receivers, const uint32_t *order,
                                uint32_t order_count, uint32_t samples);
/// Stores them in the lightmap, whose states are known.
alp_result alpi_bake_store_side_maps(alpi_bake_job *job);

/// Bytes of ours that a bake of these maps on this atlas holds at its peak, the scene and the
/// tracer apart.
uint64_t alpi_bake_memory(const alp_atlas_info *atlas, unsigned maps);
/// LIMIT when that is more than nine tenths of the machine's memory.
alp_result alpi_bake_check_memory(const alpi_bake_job *job, const alp_atlas_info *atlas);

/// Fails before the long work if an output could not be written at its end. Asked for one page
/// before the atlas is made, and for all of them after.
alp_result alpi_bake_check_outputs(const alpi_bake_job *job, uint32_t pages);
/// Writes maps and asset; nothing appears at its place before everything is encoded.
alp_result alpi_bake_write_outputs(alpi_bake_job *job);

/// Refuses what has no meaning together with the choice of values at vertices or of maps.
alp_result alpi_bake_check_vertex_options(const alpi_bake_job *job);
/// The whole job of ALP_ATLAS_VERTEX, after the options were checked.
alp_result alpi_bake_vertices(alpi_bake_job *job);

/// The object that goes to asset.extras.alpenglow, as text that the caller releases; NULL without
/// memory.
char *alpi_bake_make_extras(const alpi_bake_job *job);
/// A warning when nearly nothing is open.
void alpi_bake_warn_of_darkness(const alpi_bake_job *job);

/// Multiplies each value by the occlusion map that the texel's material has already.
void alpi_bake_multiply_existing(const alpi_bake_job *job, float *accessibility);

#endif
