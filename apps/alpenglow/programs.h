// SPDX-License-Identifier: MIT
// Programs that a command runs in its place, and files that lie beside it.
#ifndef COMMAND_PROGRAMS_H
#define COMMAND_PROGRAMS_H

#include <stdbool.h>

enum { PROGRAM_PATH_SIZE = 4096 };

/// Writes the path of a program that lies in `folder`, relative to the folder of this program.
/// @return false: there is none
bool program_find_beside(const char *folder, const char *name, char path[PROGRAM_PATH_SIZE]);
/// The same for a file that can be read.
bool file_find_beside(const char *folder, const char *name, char path[PROGRAM_PATH_SIZE]);
/// Writes the path of a program in one of the folders of PATH.
bool program_find_on_path(const char *name, char path[PROGRAM_PATH_SIZE]);

/// Replaces this program.
/// @param words [], the last is NULL; the first is the program's name
/// @return EXIT_FAILED after a message
int program_run(const char *path, char *const words[]);

#endif
