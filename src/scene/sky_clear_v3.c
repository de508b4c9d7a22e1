// SPDX-License-Identifier: MIT
// The clear sky in many directions, for x86-64-v3 (AVX2); CMakeLists.txt compiles it with
// -march=x86-64-v3.
#define ALPI_CLEAR_SKY alpi_clear_sky_radiances_v3
#include "scene/sky_clear_body.h"
