// SPDX-License-Identifier: MIT
// The shared library that a program found, which may be another than the one it was built with.
#ifndef COMMAND_LIBRARY_H
#define COMMAND_LIBRARY_H

/// Compares the version of the library with that of the headers. A later library has all functions
/// of an earlier one, as long as the loader accepts its name.
/// @return EXIT_DONE, or EXIT_FAILED after a message: the library is older than this program
int library_check(void);

#endif
