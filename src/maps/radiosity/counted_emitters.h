// SPDX-License-Identifier: MIT
// Emissive surfaces as a gatherer's rays happen to see them: each counts by the pixels that it
// takes, in the place of its closed form and of rays aimed at it.
//
// What is right in the mean and has an error of the size of its rim: at worst the weights of all
// pixels that an emitter's edges cross. Small and far emitters fall between pixels.
// Based on: H. Elias. Radiosity (emitters in the hemicube).
#ifndef ALPI_MAPS_COUNTED_EMITTERS_H
#define ALPI_MAPS_COUNTED_EMITTERS_H

#include "transport/gather/gather.h"

/// Adds the irradiance that the listed receivers have straight from emissive surfaces to values,
/// and to light by direction where it is wanted. No variance: the gatherer does not know its error.
/// @param job from (only scene, tracer and filter are read), gatherer, receivers, list, count,
///            values and directional [receivers], which are added to; all else is not read
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
/// Cost: all rays of the gatherer for each receiver, and 24 bytes of each, with directional more.
alp_result alpi_counted_emitters_add(const alpi_gather_job *job,
                                     const alpi_task_progress *progress);

/// A scene whose materials emit nothing: all else is borrowed from the scene, which must outlive
/// it. Its materials are released by alpi_scene_without_emitters_clear.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_scene_without_emitters(const alp_scene *scene, alp_scene *dark);
void alpi_scene_without_emitters_clear(alp_scene *dark); // of all zeros it does nothing

#endif
