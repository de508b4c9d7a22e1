// SPDX-License-Identifier: MIT
// The loops over few triangles for x86-64-v3 (AVX2); CMakeLists.txt compiles them with
// -march=x86-64-v3.
#define ALPI_FEW_LOOPS alpi_few_loops_v3
#include "trace/few_body.h"
