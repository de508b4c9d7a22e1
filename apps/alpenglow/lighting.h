// SPDX-License-Identifier: MIT
// The options that say what light falls on a scene: --sky, --sun and theirs, and lamps.
#ifndef COMMAND_LIGHTING_H
#define COMMAND_LIGHTING_H

#include "lamps.h"

/// What the arguments say, apart from the picture of the sky.
/// @param lamps out: what `options` borrows
/// @return EXIT_DONE, or EXIT_USAGE after a message
int lighting_read(const command_line *arguments, alp_lighting_options *options, lamp_list *lamps);

/// Loads the picture of the sky, if --sky names one, for `options` to borrow.
/// @param image out: NULL, or what the caller destroys after the work
/// @return EXIT_DONE, or EXIT_FAILED after a message
int lighting_load_sky(session *s, const command_line *arguments, alp_lighting_options *options,
                      alp_image **image);

/// --bounces
uint32_t lighting_bounces(const command_line *arguments);

#endif
