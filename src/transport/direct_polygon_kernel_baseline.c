// SPDX-License-Identifier: MIT
// The loops over light of polygons for any machine.
#define ALPI_POLYGON_LOOPS alpi_polygon_loops_baseline
#include "transport/direct_polygon_kernel_body.h"
