// SPDX-License-Identifier: MIT
// The loops over camera rays for any machine.
#define ALPI_CAMERA_LOOPS alpi_camera_loops_baseline
#include "render/camera_rays_body.h"
