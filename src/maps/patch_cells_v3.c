// SPDX-License-Identifier: MIT
// The cells that packets of rays meet, for x86-64-v3 (AVX2); CMakeLists.txt compiles it with
// -march=x86-64-v3.
#define ALPI_FIND_CELLS alpi_patches_find_cells_v3
#include "maps/patch_cells_body.h"
