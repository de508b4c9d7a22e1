// SPDX-License-Identifier: MIT
// The clear sky in single directions: of eight lanes seven would be for nothing.
#define ALPI_VARIANT(name) name##_one_by_one
#define ALPI_CLEAR_SKY_LANES 1
#include "scene/sky/sky_clear_body.h"
