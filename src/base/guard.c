// SPDX-License-Identifier: MIT
#include "base/guard.h"

#include "base/memory.h"

#include <sys/stat.h>

static bool is_same(alpi_file_id a, alpi_file_id b)
{
    return a.device == b.device && a.number == b.number;
}

/// @return false: there is no file
static bool find(const char *path, alpi_file_id *file)
{
    struct stat status;
    if (stat(path, &status) != 0) {
        return false;
    }
    *file = (alpi_file_id){status.st_dev, status.st_ino};
    return true;
}

alp_result alpi_guard_add(alp_context *context, alpi_guard *guard, const char *path)
{
    alpi_file_id file;
    if (!find(path, &file)) {
        return ALP_OK;
    }
    void *files = guard->files;
    ALP_TRY(alpi_grow(context, &files, &guard->capacity, guard->count + 1, sizeof *guard->files));
    guard->files = files;
    guard->files[guard->count++] = file;
    return ALP_OK;
}

void alpi_guard_destroy(alp_context *context, alpi_guard *guard)
{
    alpi_release(context, guard->files);
    *guard = (alpi_guard){0};
}

bool alpi_guard_holds(const alpi_guard *guard, alpi_file_id file)
{
    for (size_t i = 0; guard != NULL && i < guard->count; i++) {
        if (is_same(guard->files[i], file)) {
            return true;
        }
    }
    return false;
}

bool alpi_is_one_file(const char *a, const char *b)
{
    alpi_file_id first, second;
    return find(a, &first) && find(b, &second) && is_same(first, second);
}
