// SPDX-License-Identifier: MIT
// Name patterns: * any characters, ? one, [a-z] one of a set, [!a-z] one that is not in it, \ takes
// the next character as it is. A character is a code point of UTF-8; a byte that is none counts as
// one. No locale takes part, so that a pattern means the same everywhere.
#ifndef ALPI_BASE_GLOB_H
#define ALPI_BASE_GLOB_H

#include <stdbool.h>
#include <stddef.h>

/// Whether all of `name` is matched by the first `size` bytes of `pattern`. A [ that is never
/// closed, and a \ at the end, stand for themselves. O(pattern × name), without recursion.
bool alpi_glob_match(const char *pattern, size_t size, const char *name);

/// Bytes of the first pattern of a list with commas between; "\," is no border and neither is a
/// comma in [ ].
size_t alpi_glob_length(const char *list);

#endif
