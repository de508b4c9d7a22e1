// SPDX-License-Identifier: MIT
// Emissive surfaces measured by a gatherer's own rays: an emitter counts by the pixels that see it,
// instead of by its closed form or by rays aimed at it.
//
// The mean is right. The error is at most the weight of all pixels that edges of emitters cross.
// Small and far emitters fall between pixels.
// Based on: H. Elias. Radiosity (emitters in the hemicube).
#ifndef ALPI_MAPS_COUNTED_EMITTERS_H
#define ALPI_MAPS_COUNTED_EMITTERS_H

#include "transport/gather/gather.h"

/// Adds direct irradiance from emissive surfaces at the listed receivers to job->values and, unless
/// NULL, job->directional. Adds no variance: the gatherer does not measure its error.
/// @param job only scene, tracer and filter of `from` are read; skies and lost are ignored
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
/// Cost: all rays of the gatherer and 24 bytes for each receiver, more with directional.
alp_result alpi_counted_emitters_add(const alpi_gather_job *job,
                                     const alpi_task_progress *progress);

/// A copy of a scene whose materials emit nothing. It borrows all else from the scene, which must
/// outlive it. alpi_scene_without_emitters_clear frees its materials.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_scene_without_emitters(const alp_scene *scene, alp_scene *dark);
void alpi_scene_without_emitters_clear(alp_scene *dark); // all zeros: does nothing

#endif
