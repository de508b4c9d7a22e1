// SPDX-License-Identifier: MIT
// The stages of a bake in their order. Each lies in the file of its name. The stage of light is
// declared in light/light.h, the stage that writes in files/outputs.h.
#ifndef ALPI_BAKE_BAKE_STAGES_H
#define ALPI_BAKE_BAKE_STAGES_H

#include "bake/job.h"

/// Chooses surfaces, maps, images that occlusion is packed into, and layers of light (choose.c).
/// @return ALP_OK; INVALID_ARGUMENT: a pattern that matches nothing; OUT_OF_MEMORY
alp_result alpi_bake_choose(alpi_bake_job *job);
/// Chooses surfaces alone: fills only, occluders, originals and report.surfaces_baked.
alp_result alpi_bake_choose_surfaces(alpi_bake_job *job);

/// Makes the atlas and its texels. Fails first if an output could not be written at the end.
/// @return ALP_OK; LIMIT: too little memory for the rest; IO; OUT_OF_MEMORY; CANCELLED; others of
///         alpi_atlas_create
alp_result alpi_bake_atlas(alpi_bake_job *job);

/// Builds the ray tracer, finds texels inside other geometry, and lists the texels that the next
/// three stages gather at.
/// @return ALP_OK; LIMIT: the time is over; OUT_OF_MEMORY; CANCELLED; UNSUPPORTED
alp_result alpi_bake_receivers(alpi_bake_job *job);

/// Traces occlusion and bent normals, if a map needs them.
/// @return ALP_OK; LIMIT: the time was over before any texel had a value; OUT_OF_MEMORY; CANCELLED
alp_result alpi_bake_occlusion(alpi_bake_job *job);

/// Traces coloured obscurance, if it is asked for.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_bake_obscurance(alpi_bake_job *job);

/// Moves the gathered values to the pages of the lightmap, and closes the gathering.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_bake_store(alpi_bake_job *job);

/// Measures the seams of the stored maps and stitches them, if that is asked for (bake_seams.c).
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_bake_stitch(alpi_bake_job *job);

/// The stages of ALP_ATLAS_VERTEX after check and choose (bake_vertices.c).
alp_result alpi_bake_vertices(alpi_bake_job *job);

#endif
