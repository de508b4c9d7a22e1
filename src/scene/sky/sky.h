// SPDX-License-Identifier: MIT
// The sky: radiance by direction, and directions drawn in proportion to it.
#ifndef ALPI_SCENE_SKY_H
#define ALPI_SCENE_SKY_H

#include "base/vec.h"

#include <alpenglow/light.h>

typedef struct alpi_sky alpi_sky;             // immutable
typedef struct alpi_sky_looks alpi_sky_looks; // sky_spots.h

/// @param sun_direction towards the sun, unit; read by the clear sky only, which leaves the sun's
///                      disk to the caller
/// @return ALP_OK with NULL for a sky that is black; INVALID_ARGUMENT (a value out of range, not
///         finite; an image of the wrong kind or shape); OUT_OF_MEMORY
alp_result alpi_sky_create(alp_context *context, const alp_sky_options *options, vec3 sun_direction,
                           alpi_sky **sky);
void alpi_sky_destroy(alp_context *context, alpi_sky *sky); // NULL does nothing

/// Whether it has an image, which may have bright spots. Other skies are soft as a whole.
bool alpi_sky_is_image(const alpi_sky *sky);
/// The sky as two whose radiances add up to its own: a soft one, for rays that leave the scene, and
/// the bright spots of an image, to be asked. Even skies are soft as a whole.
/// @param soft, spots out: NULL where black. Both are the caller's
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_sky_split(alp_context *context, const alpi_sky *sky, alpi_sky **soft,
                          alpi_sky **spots);
/// Where to look, of the spots of another; else NULL. As long as the sky.
const alpi_sky_looks *alpi_sky_spot_looks(const alpi_sky *sky);

/// Radiance from a unit direction. Images are bilinear between texel centres, wrapping around; what
/// is sampled and what is looked up are the same function.
vec3 alpi_sky_radiance(const alpi_sky *sky, vec3 direction);
/// The same of [count] directions, faster.
void alpi_sky_radiances(const alpi_sky *sky, const vec3 *directions, uint32_t count,
                        vec3 *radiances);

/// Draws a direction. @param u [0,1)²  @param density out, may be NULL: per steradian, > 0
vec3 alpi_sky_sample(const alpi_sky *sky, vec2 u, float *density);
/// Density that alpi_sky_sample draws a direction with; > 0 wherever the radiance is.
float alpi_sky_density(const alpi_sky *sky, vec3 direction);

/// ∫ radiance dω / 4π.
vec3 alpi_sky_mean(const alpi_sky *sky);

#endif
