// SPDX-License-Identifier: MIT
// alpenglow bench: runs alpenglow-bench, a separate program, which uses internals of the library
// and calls the ray tracer directly.
#include "messages.h"
#include "options/options.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 4096, WORD_LIMIT = 8 };

/// Writes the path of the bench program in `folder`, relative to the folder of this program.
static bool find_beside(const char *folder, char path[PATH_SIZE])
{
    char self[PATH_SIZE];
    const ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length <= 0) {
        return false;
    }
    self[length] = '\0';
    char *slash = strrchr(self, '/');
    if (slash == NULL) {
        return false;
    }
    *slash = '\0';
    const int written = snprintf(path, PATH_SIZE, "%s/%s/alpenglow-bench", self, folder);
    return written > 0 && written < PATH_SIZE && access(path, X_OK) == 0;
}

int command_bench(const command_line *a)
{
    static char path[PATH_SIZE], name[] = "alpenglow-bench", quick[] = "--quick";
    static char markdown[] = "--markdown", scene[] = "--scene";
    static char room[64], scene_name[PATH_SIZE];
    char *words[WORD_LIMIT] = {name};
    int count = 1;
    if (!find_beside(".", path) && !find_beside(ALP_BENCH_FOLDER, path)) {
        return failure("alpenglow-bench is neither beside this program nor in its libexec folder; "
                       "build or install it (cmake --build, cmake --install)");
    }
    if (a->operands[0] != NULL) {
        snprintf(room, sizeof room, "%s", a->operands[0]);
        words[count++] = room;
    }
    if (a->values[OPTION_QUICK].given) {
        words[count++] = quick;
    }
    if (a->values[OPTION_MARKDOWN].given) {
        words[count++] = markdown;
    }
    if (a->values[OPTION_BENCH_SCENE].given) {
        snprintf(scene_name, sizeof scene_name, "%s", a->values[OPTION_BENCH_SCENE].text);
        words[count++] = scene;
        words[count++] = scene_name;
    }
    fflush(stdout);
    execv(path, words);
    fprintf(stderr, "alpenglow: %s: %s\n", path, strerror(errno));
    return EXIT_FAILED;
}
