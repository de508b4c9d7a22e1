// SPDX-License-Identifier: MIT
// The loops over waves of paths for x86-64-v3 (AVX2); CMakeLists.txt compiles them with -march=x86-64-v3.
#define ALPI_WAVE_LOOPS alpi_wave_loops_v3
#include "transport/path_wave_body.h"
