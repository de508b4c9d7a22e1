// SPDX-License-Identifier: MIT
#ifndef ALPI_SCENE_LIGHTING_OPTIONS_H
#define ALPI_SCENE_LIGHTING_OPTIONS_H

#include "base/context.h"
#include "base/vec.h"

#include <alpenglow/light.h>

/// All but the sky, which alpi_sky_create checks.
/// @return ALP_OK; INVALID_ARGUMENT (named)
alp_result alpi_lighting_options_check(alp_context *context, const alp_lighting_options *options);

/// Towards the sun of the options, unit.
vec3 alpi_sun_direction(const alp_sun_options *sun);

#endif
