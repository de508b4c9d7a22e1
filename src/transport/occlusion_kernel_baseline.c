// SPDX-License-Identifier: MIT
// The occlusion kernel for any machine.
#define ALPI_KERNEL alpi_occlusion_kernel_baseline
#include "transport/occlusion_kernel_body.h"
