// SPDX-License-Identifier: MIT
// Words that depend on a count.
#ifndef ALPI_BASE_PLURAL_H
#define ALPI_BASE_PLURAL_H

#include <stdint.h>

/// "s" unless there is one.
static inline const char *alpi_plural(uint64_t count)
{
    return count == 1 ? "" : "s";
}

/// The first word for one, else the second.
static inline const char *alpi_one_or_many(uint64_t count, const char *one, const char *many)
{
    return count == 1 ? one : many;
}

#endif
