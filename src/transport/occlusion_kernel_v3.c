// SPDX-License-Identifier: MIT
// The occlusion kernel for x86-64-v3 (AVX2); CMakeLists.txt compiles it with -march=x86-64-v3.
#define ALPI_KERNEL alpi_occlusion_kernel_v3
#include "transport/occlusion_kernel_body.h"
