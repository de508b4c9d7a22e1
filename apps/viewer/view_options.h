// SPDX-License-Identifier: MIT
// The command line of view.
#ifndef VIEWER_VIEW_OPTIONS_H
#define VIEWER_VIEW_OPTIONS_H

#include "setup/lamps.h"
#include "view_modes.h"

/// The settings that the arguments give.
typedef struct view_settings {
    const view_mode *mode;
    alp_render_options render; // camera, size, atlas, lighting, bounces, seed
    lamp_list lamps;           // borrowed by `render`
    alp_film_options film;
} view_settings;

/// Reads and checks the arguments, and whether the output can be written. `settings` must not move.
/// @return EXIT_DONE, or an exit code after a message
int view_settings_read(const command_line *arguments, view_settings *settings);

#endif
