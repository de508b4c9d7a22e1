// SPDX-License-Identifier: MIT
// The sun's day: --day.
#ifndef COMMAND_DAY_H
#define COMMAND_DAY_H

#include <alpenglow/light.h>

/// Light of one moment of a day.
///
/// The sun moves along the great circle through its place at noon and the west and east points of
/// the horizon. Low, it is weaker by a simple model of air. At night it keeps a ten-thousandth of
/// its light, and a clear sky a hundredth of dusk, so that something lights the scene.
/// @param noon    the light at the beginning, when the sun stands highest; it has a sun
/// @param seconds length of the day; 0 = the sun stands still
/// @param time    seconds since noon
alp_lighting_options day_lighting(const alp_lighting_options *noon, double seconds, double time);

#endif
