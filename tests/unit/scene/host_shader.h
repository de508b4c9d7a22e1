// SPDX-License-Identifier: MIT
// The formulas of geometry.h as a host computes them, by public calls alone.
#ifndef HOST_SHADER_H
#define HOST_SHADER_H

#include <alpenglow/geometry.h>

/// Albedo in three channels, and alpha, at a point of a triangle. Images have four channels.
void host_shade(const alp_scene *scene, uint32_t triangle, double b1, double b2, double rgba[4]);

#endif
