// SPDX-License-Identifier: MIT
#include "programs.h"

#include "options/options.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// Joins the parts of a path. @param use X_OK or R_OK @return whether the file can be used so
static bool is_usable(const char *folder, size_t length, const char *name, int use,
                      char path[PROGRAM_PATH_SIZE])
{
    const int written = snprintf(path, PROGRAM_PATH_SIZE, "%.*s/%s", (int)length, folder, name);
    return written > 0 && written < PROGRAM_PATH_SIZE && access(path, use) == 0;
}

static bool find_beside(const char *folder, const char *name, int use, char path[PROGRAM_PATH_SIZE])
{
    char self[2 * PROGRAM_PATH_SIZE];
    const ssize_t length = readlink("/proc/self/exe", self, PROGRAM_PATH_SIZE);
    if (length <= 0 || length >= PROGRAM_PATH_SIZE) {
        return false;
    }
    self[length] = '\0';
    char *slash = strrchr(self, '/');
    if (slash == NULL) {
        return false;
    }
    const size_t start = (size_t)(slash + 1 - self), room = sizeof self - start;
    const int written = snprintf(slash + 1, room, "%s", folder);
    return written >= 0 && (size_t)written < room && is_usable(self, strlen(self), name, use, path);
}

bool program_find_beside(const char *folder, const char *name, char path[PROGRAM_PATH_SIZE])
{
    return find_beside(folder, name, X_OK, path);
}

bool file_find_beside(const char *folder, const char *name, char path[PROGRAM_PATH_SIZE])
{
    return find_beside(folder, name, R_OK, path);
}

bool program_find_on_path(const char *name, char path[PROGRAM_PATH_SIZE])
{
    for (const char *at = getenv("PATH"); at != NULL;) {
        const size_t length = strcspn(at, ":");
        if (length > 0 && is_usable(at, length, name, X_OK, path)) {
            return true;
        }
        at = at[length] == ':' ? at + length + 1 : NULL;
    }
    return false;
}

int program_run(const char *path, char *const words[])
{
    fflush(stdout);
    execv(path, words);
    fprintf(stderr, "alpenglow: %s: %s\n", path, strerror(errno));
    return EXIT_FAILED;
}
