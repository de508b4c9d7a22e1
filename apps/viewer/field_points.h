// SPDX-License-Identifier: MIT
// Look-ups of a field at many points, spread over the cores.
#ifndef VIEWER_FIELD_POINTS_H
#define VIEWER_FIELD_POINTS_H

#include <alpenglow/field.h>

/// alp_field_irradiance by several threads. Any number of workers gives the same bits.
/// @param workers at least 1; threads that cannot be made are done without
void field_points_read(const alp_field *field, uint32_t workers, uint32_t count,
                       const float (*positions)[3], const float (*normals)[3],
                       float (*irradiance)[3]);

#endif
