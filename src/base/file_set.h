// SPDX-License-Identifier: MIT
// Files that belong together: all of them appear, or none.
#ifndef ALPI_BASE_FILE_SET_H
#define ALPI_BASE_FILE_SET_H

#include "base/file.h"

typedef struct alpi_file_set {
    alp_context *context;
    bool overwrite;
    alpi_file_writer *writers; // finished, not in place
    size_t count, capacity;
} alpi_file_set;

static inline alpi_file_set alpi_file_set_create(alp_context *context, bool overwrite)
{
    return (alpi_file_set){.context = context, .overwrite = overwrite};
}

/// Writes one of them beside its place. @return ALP_OK; IO; OUT_OF_MEMORY; CANCELLED
alp_result alpi_file_set_add(alpi_file_set *set, const char *path, const void *bytes, size_t size);

/// Puts all in their places and empties the set. Where one cannot be put there, those before it are
/// taken back: what was there before is there again (on file systems without hard links it is not).
alp_result alpi_file_set_commit(alpi_file_set *set);
/// Removes what was written. Harmless after commit.
void alpi_file_set_abandon(alpi_file_set *set);

/// Commits after ALP_OK, else abandons. @return `result`, or what went wrong
alp_result alpi_file_set_end(alpi_file_set *set, alp_result result);

#endif
