// SPDX-License-Identifier: MIT
// --animation and --animation-time.
#ifndef COMMAND_ANIMATION_H
#define COMMAND_ANIMATION_H

#include "session.h"

/// Refuses --animation where nothing is posed. @return EXIT_DONE, or EXIT_USAGE after a message
int animation_check(const command_line *arguments);
/// Finds the animation of the scene that is loaded.
/// @param animation out
/// @return EXIT_DONE, or EXIT_FAILED after a message that lists them
int animation_find(const session *s, const command_line *arguments, uint32_t *animation);
/// Poses the scene that is loaded, if --animation-time is given.
/// @return EXIT_DONE, or EXIT_FAILED after a message
int animation_pose(session *s, const command_line *arguments);
/// Whether --animation is "none".
bool animation_is_none(const command_line *arguments);

#endif
