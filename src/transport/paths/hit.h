// SPDX-License-Identifier: MIT
// The point that a ray hit, as a place to gather light at.
#ifndef ALPI_TRANSPORT_HIT_H
#define ALPI_TRANSPORT_HIT_H

#include "scene/receivers.h"
#include "trace/trace.h"

/// The point of lane `lane`, its normals on the side that the ray came from. A shading normal that
/// points below the triangle is replaced by the triangle's.
/// @param from_behind out, or NULL: the ray met the back of the triangle
alpi_receiver_point alpi_hit_point(const alp_scene *scene, const alpi_hits *hits, int lane,
                                   vec3 direction, bool *from_behind);

#endif
