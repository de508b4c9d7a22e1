// SPDX-License-Identifier: MIT
// The instruction sets of ranks. Results are the same bits on one level only.
#ifndef RANKS_LEVELS_H
#define RANKS_LEVELS_H

#include <stdint.h>

enum { LEVEL_LEAST = 0, LEVEL_MOST = 4 };

/// The level of this machine.
int levels_own(void);
/// The max_isa that gives all ranks the same instructions.
/// @param levels [count] of the ranks
/// @return NULL: all have the same level, and need no limit
const char *levels_lowest(const int *levels, uint32_t count);

#endif
