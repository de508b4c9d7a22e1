// SPDX-License-Identifier: MIT
// The clear sky in many directions, for any machine.
#define ALPI_CLEAR_SKY alpi_clear_sky_radiances_baseline
#include "scene/sky_clear_body.h"
