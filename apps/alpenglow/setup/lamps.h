// SPDX-License-Identifier: MIT
// The lamps of the command line: --lamp and --spot.
#ifndef COMMAND_LAMPS_H
#define COMMAND_LAMPS_H

#include "session.h"

typedef struct lamp_list {
    alp_lamp lamps[REPEAT_LIMIT];
    uint32_t count;
} lamp_list;

/// All of them, in the order in which they are given.
/// @param origin of the scene in the world of its file (alp_scene_info)
/// @return EXIT_DONE, or EXIT_USAGE after a message
int lamps_read(const command_line *arguments, const double origin[3], lamp_list *list);

/// Takes a colour over. @return false: a channel is negative
bool color_set(const double numbers[3], float color[3]);

#endif
