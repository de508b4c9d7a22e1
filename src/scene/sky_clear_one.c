// SPDX-License-Identifier: MIT
// The clear sky in single directions: of eight lanes seven would be for nothing.
#define ALPI_CLEAR_SKY alpi_clear_sky_radiances_one_by_one
#define ALPI_CLEAR_SKY_LANES 1
#include "scene/sky_clear_body.h"
