// SPDX-License-Identifier: MIT
// The ground of a scene, for flat ambience volumes.
#ifndef ALPI_FIELDS_AMBIENCE_GROUND_H
#define ALPI_FIELDS_AMBIENCE_GROUND_H

#include "trace/trace.h"

/// Height of the ground at a place, metres: that of the topmost surface. A surface over 3 m
/// above the lowest one within 2 m along x and z is a thing on the ground: the lowest one counts.
/// Outside of the scene: its lowest height.
double alpi_ground_height(const alp_scene *scene, const alpi_tracer *tracer, double x, double z);

#endif
