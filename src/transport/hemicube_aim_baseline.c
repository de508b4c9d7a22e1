// SPDX-License-Identifier: MIT
// Rays of a hemicube's packet, for any machine.
#define ALPI_HEMICUBE_AIM alpi_hemicube_aim_baseline
#include "transport/hemicube_aim_body.h"
