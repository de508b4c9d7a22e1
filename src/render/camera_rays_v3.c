// SPDX-License-Identifier: MIT
// The loops over camera rays for x86-64-v3 (AVX2); CMakeLists.txt compiles them with
// -march=x86-64-v3.
#define ALPI_CAMERA_LOOPS alpi_camera_loops_v3
#include "render/camera_rays_body.h"
