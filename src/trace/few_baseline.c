// SPDX-License-Identifier: MIT
// The loops over few triangles for any machine.
#define ALPI_FEW_LOOPS alpi_few_loops_baseline
#include "trace/few_body.h"
