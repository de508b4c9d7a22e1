// SPDX-License-Identifier: MIT
// What every sky must hold to: its density is one, and what is drawn from it follows it.
#ifndef SKY_CHECKS_H
#define SKY_CHECKS_H

#include "test_support.h"

#include "scene/sky/sky.h"

/// Options as alp_lighting_options_default gives them, of a kind.
alp_sky_options sky_options(alp_sky_kind kind);
alpi_sky *sky_make(alp_context *context, const alp_sky_options *options, vec3 sun);
/// Fails unless creation is refused with INVALID_ARGUMENT and `word` in the message.
void sky_refuse(alp_context *context, const alp_sky_options *options, vec3 sun, const char *word);

vec3 sky_polar(double theta, double phi); // φ from −Z towards +X
double sky_luminance(vec3 radiance);

/// E per channel on a surface with a normal: midpoint sum over rows × 2 rows of directions.
void sky_irradiance_sum(const alpi_sky *sky, vec3 normal, int rows, double irradiance[3]);
/// E per channel from `count` drawn directions with its standard error.
void sky_irradiance_drawn(const alpi_sky *sky, vec3 normal, uint32_t count, double irradiance[3],
                          double error[3]);

/// The density integrates to 1, drawn directions have the density that is told, and their
/// histogram passes a chi² test.
/// @param rows of the midpoint sums; a multiple of 16
void sky_check_density(const alpi_sky *sky, int rows);

#endif
