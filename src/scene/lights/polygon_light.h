// SPDX-License-Identifier: MIT
// The closed form of light from a polygon.
#ifndef ALPI_SCENE_POLYGON_LIGHT_H
#define ALPI_SCENE_POLYGON_LIGHT_H

#include "base/vec.h"

#include <stdint.h>

/// Form factor from a point to a polygon of even radiance L that nothing hides, so that its
/// irradiance is E = π L F:
///
///     F = −Σ γ_i (n·Γ_i) / 2π,   Γ_i = unit(v_i × v_i+1),   γ_i the angle between v_i and v_i+1
///
/// over the edges that are left above the horizon and those the horizon cuts. Double precision.
/// @param normal  unit: the side that gathers
/// @param corners [count] of a simple flat polygon; the point may lie in its plane or on an edge
///                (0), and comes as close as floats do
/// @return positive where the corners run counter-clockwise seen from the point, else negative
/// Based on: Lambert. Photometria, 1760; clipped as in Baum, Rushmeier, Winget. Improving Radiosity
/// Solutions Through the Use of Analytically Determined Form-Factors. SIGGRAPH 1989.
double alpi_polygon_form_factor(vec3 point, vec3 normal, const vec3 *corners, uint32_t count);

#endif
