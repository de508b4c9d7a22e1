// SPDX-License-Identifier: MIT
// The ground of a scene, for flat ambience volumes.
#ifndef ALPI_FIELDS_AMBIENCE_GROUND_H
#define ALPI_FIELDS_AMBIENCE_GROUND_H

#include "trace/trace.h"

/// Height of the ground at a place, metres: that of the topmost surface. A surface more than 3 m
/// above the lowest one nearby is a thing on the ground: then the lowest one counts. Nearby: within
/// 2 m along x and z. Outside of the scene: its lowest height.
double alpi_ground_height(const alp_scene *scene, const alpi_tracer *tracer, double x, double z);

#endif
