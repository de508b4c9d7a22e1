// SPDX-License-Identifier: MIT
// Rays of a hemicube's packet, for x86-64-v3 (AVX2); CMakeLists.txt compiles it
// with -march=x86-64-v3.
#define ALPI_HEMICUBE_AIM alpi_hemicube_aim_v3
#include "transport/hemicube_aim_body.h"
