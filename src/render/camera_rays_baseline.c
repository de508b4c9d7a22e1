// SPDX-License-Identifier: MIT
// The loops over camera rays for any machine, and the choice of loops.
#define ALPI_CAMERA_LOOPS alpi_camera_loops_baseline
#include "render/camera_rays_body.h"

const alpi_camera_loops *alpi_camera_loops_for(const alp_context *context)
{
#ifdef ALPI_HAS_V3_KERNEL
    if (alpi_context_has_v3(context)) {
        return &alpi_camera_loops_v3;
    }
#endif
    (void)context;
    return &alpi_camera_loops_baseline;
}
