// SPDX-License-Identifier: MIT
// The loops over light of polygons for x86-64-v3 (AVX2); CMakeLists.txt compiles them with
// -march=x86-64-v3.
#define ALPI_POLYGON_LOOPS alpi_polygon_loops_v3
#include "transport/direct_polygon_kernel_body.h"
