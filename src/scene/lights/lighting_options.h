// SPDX-License-Identifier: MIT
#ifndef ALPI_SCENE_LIGHTING_OPTIONS_H
#define ALPI_SCENE_LIGHTING_OPTIONS_H

#include "scene/scene.h"

#include <alpenglow/light.h>

/// All but the sky, which alpi_sky_create checks.
/// @return ALP_OK; INVALID_ARGUMENT (named)
alp_result alpi_lighting_options_check(alp_context *context, const alp_lighting_options *options);

/// Fingerprint of all fields by value, with the lamps and the pixels of a sky image. The options
/// need no check before.
uint64_t alpi_lighting_options_hash(const alp_lighting_options *options);
/// Continues a hash (base/hash.h) over the lamps alone.
uint64_t alpi_lamps_hash(uint64_t hash, const alp_lighting_options *options);

/// A checked lamp as a light. @param name borrowed
alpi_light alpi_lamp_light(const alp_lamp *lamp, char *name);

/// Towards the sun of the options, unit.
vec3 alpi_sun_direction(const alp_sun_options *sun);

#endif
