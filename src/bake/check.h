// SPDX-License-Identifier: MIT
// The refusals of a bake's options. No other file of this room refuses an option.
#ifndef ALPI_BAKE_CHECK_H
#define ALPI_BAKE_CHECK_H

#include "bake/job.h"

/// Refuses options that are out of range or make no sense together, and a scene without anything to
/// bake. Reads nothing but the options and the scene.
/// @return ALP_OK; INVALID_ARGUMENT; INVALID_DATA: the scene has no usable triangle; UNSUPPORTED:
///         the output's kind of file, or a thing that it has no place for
alp_result alpi_bake_check(const alpi_bake_job *job);

/// The part of it that is about light (check_light.c).
alp_result alpi_bake_check_light(const alpi_bake_job *job);

/// Refuses a bake of light where nothing lights the scene (check_light.c). The estimate of work
/// does not call it, because light may still be added.
/// @return ALP_OK; INVALID_ARGUMENT; OUT_OF_MEMORY
alp_result alpi_bake_check_lit(const alpi_bake_job *job);

#endif
