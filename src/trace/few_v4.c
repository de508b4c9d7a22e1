// SPDX-License-Identifier: MIT
// The loops over few triangles for x86-64-v4 (AVX-512); CMakeLists.txt compiles them with
// -march=x86-64-v4.
#define ALPI_FEW_LOOPS alpi_few_loops_v4
#include "trace/few_body.h"
