// SPDX-License-Identifier: MIT
// The cells that packets of rays meet, for any machine.
#define ALPI_FIND_CELLS alpi_patches_find_cells_baseline
#include "maps/patch_cells_body.h"
