// SPDX-License-Identifier: MIT
// The volume of alpenglow lpv as a file.
#ifndef COMMAND_LPV_VOLUME_H
#define COMMAND_LPV_VOLUME_H

#include "lpv/lpv_run.h"

/// Fluence of a cell: 4 pi p0 / (1.5 s^2), s the side of the cell.
/// @param fluence out, red, green and blue, W/m2, >= 0
void lpv_cell_fluence(const alp_lpv_grid *grid, const uint32_t cell[3], float fluence[3]);

/// Checks before long work that --volume can be written.
/// @return EXIT_DONE, also without --volume, or EXIT_USAGE or EXIT_FAILED after a message
int lpv_volume_check(const command_line *arguments);
/// Writes the fluence of all cells of the last frame, as docs/manual/lpv.md describes it.
/// @return EXIT_DONE, also without --volume, or EXIT_FAILED after a message
int lpv_volume_write(const lpv_run *run, const command_line *arguments);

#endif
