// SPDX-License-Identifier: MIT
// Finds a command by its name and runs it.
#ifndef COMMAND_DISPATCH_H
#define COMMAND_DISPATCH_H

/// Runs the command of a command line.
/// @param words [count] after the name of the program
/// @return the exit code
int command_dispatch(int count, char **words);

#endif
