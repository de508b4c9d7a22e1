// SPDX-License-Identifier: MIT
// The loops over waves of paths for any machine.
#define ALPI_WAVE_LOOPS alpi_wave_loops_baseline
#include "transport/path_wave_body.h"
