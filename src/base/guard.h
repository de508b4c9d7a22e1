// SPDX-License-Identifier: MIT
// Files that nothing overwrites, even where other files may be overwritten.
#ifndef ALPI_BASE_GUARD_H
#define ALPI_BASE_GUARD_H

#include "base/context.h"

#include <sys/types.h>

/// A file by its place on the disk, whatever its name.
typedef struct alpi_file_id {
    dev_t device;
    ino_t number;
} alpi_file_id;

typedef struct alpi_guard {
    alpi_file_id *files; // [count]
    size_t count, capacity;
} alpi_guard;

/// Adds the file at `path`, if there is one. @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_guard_add(alp_context *context, alpi_guard *guard, const char *path);
void alpi_guard_destroy(alp_context *context, alpi_guard *guard);
/// Whether the guard holds the file. @param guard NULL: it holds none
bool alpi_guard_holds(const alpi_guard *guard, alpi_file_id file);

/// The guard that alpi_file_check_writable consults, kept by the context; NULL there: none.
const alpi_guard **alpi_context_guard(alp_context *context);

/// Whether two paths name one file that is there.
bool alpi_is_one_file(const char *a, const char *b);

#endif
