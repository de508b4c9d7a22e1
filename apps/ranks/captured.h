// SPDX-License-Identifier: MIT
// Output of a rank that prints nothing unless it alone fails.
#ifndef RANKS_CAPTURED_H
#define RANKS_CAPTURED_H

#include <stdint.h>

/// Drops standard output, and keeps standard error in a file without a name.
void captured_begin(void);
/// Prints what was kept to the former standard error, "rank N: " before each line.
void captured_print(uint32_t rank);

#endif
