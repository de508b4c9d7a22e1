// SPDX-License-Identifier: MIT
// Spots of findings in pictures: where to look from, and a ring around them.
#ifndef ALPI_DOCTOR_DOCTOR_SPOT_H
#define ALPI_DOCTOR_DOCTOR_SPOT_H

#include "render/camera_rays.h"
#include "trace/trace.h"

#include <alpenglow/doctor.h>

/// Moves the camera to where the spot is seen from nearby; leaves it where nothing sees it.
void alpi_doctor_aim(const alp_scene *scene, const alpi_tracer *tracer,
                     const alp_finding_spot *spot, alp_camera *camera);

/// A magenta ring around a point of a picture of 8-bit RGB; a point that is not finite gets none.
void alpi_doctor_ring(uint8_t *bytes, uint32_t width, uint32_t height, double x, double y);
/// The same around a point of the scene; behind the camera there is none.
void alpi_doctor_ring_in_view(const alpi_view *view, vec3 at, uint8_t *bytes);

#endif
