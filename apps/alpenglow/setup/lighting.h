// SPDX-License-Identifier: MIT
// Options of light: --sky, --sun, their settings, and lamps.
#ifndef COMMAND_LIGHTING_H
#define COMMAND_LIGHTING_H

#include "setup/lamps.h"

/// Reads the arguments, except the image of the sky.
/// @param lamps out: borrowed by `options`
/// @return EXIT_DONE, or EXIT_USAGE after a message
int lighting_read(const command_line *arguments, alp_lighting_options *options, lamp_list *lamps);

/// Opens the session of a command, loads its scene, places the lamps in it, and loads the image of
/// the sky. Ctrl-C then stops the command. `s` must not move in memory.
/// @param options of lighting_read; borrows `lamps` and `sky`
/// @param sky     out: NULL, or the image, which the caller destroys after the work
/// @return EXIT_DONE, or EXIT_FAILED after a message; session_close in both cases
int lighting_open(session *s, const command_line *arguments, alp_lighting_options *options,
                  lamp_list *lamps, alp_image **sky);

/// --bounces
uint32_t lighting_bounces(const command_line *arguments);

/// --quality or --error, as a share; 0 without them. @return EXIT_DONE, or EXIT_USAGE: both are
/// given
int error_read(const command_line *arguments, float *error);
/// Refuses a wanted error of light where the number of rays is fixed, or the error is not known.
/// @param samples the command's option for rays per texel
int error_check_light(const command_line *arguments, option_id samples);

#endif
