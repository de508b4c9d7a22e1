// SPDX-License-Identifier: MIT
// Pictures of alpenglow lpv: slices of its grids, and a view beside the reference.
#ifndef COMMAND_LPV_PICTURES_H
#define COMMAND_LPV_PICTURES_H

#include "lpv/lpv_run.h"

/// Makes the folder of --pictures, and checks that its files can be written.
/// @return EXIT_DONE, also without --pictures, or EXIT_FAILED after a message
int lpv_pictures_check(const command_line *arguments);
/// Writes the pictures of the last frame.
/// @param view size, camera and progress of the view
/// @return EXIT_DONE, also without --pictures, or an exit code after a message
int lpv_pictures_write(lpv_run *run, const command_line *arguments, const alp_render_options *view);

#endif
