// SPDX-License-Identifier: MIT
// Options of light: --sky, --sun, their settings, and lamps.
#ifndef COMMAND_LIGHTING_H
#define COMMAND_LIGHTING_H

#include "lamps.h"

/// Reads the arguments, except the image of the sky.
/// @param lamps out: borrowed by `options`
/// @return EXIT_DONE, or EXIT_USAGE after a message
int lighting_read(const command_line *arguments, alp_lighting_options *options, lamp_list *lamps);

/// Places the lamps in the scene that was loaded.
void lighting_place(const session *s, const command_line *arguments, lamp_list *lamps);

/// Loads the image of the sky, if --sky names one. `options` borrows it.
/// @param image out: NULL, or the image, which the caller destroys after the work
/// @return EXIT_DONE, or EXIT_FAILED after a message
int lighting_load_sky(session *s, const command_line *arguments, alp_lighting_options *options,
                      alp_image **image);

/// --bounces
uint32_t lighting_bounces(const command_line *arguments);

#endif
