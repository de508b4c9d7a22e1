// SPDX-License-Identifier: MIT
// alpenglow bench: runs alpenglow-bench, a separate program, which uses internals of the library
// and calls the ray tracer directly.
#include "commands/commands.h"
#include "printing/messages.h"
#include "programs.h"

#include <stdio.h>

enum { WORD_LIMIT = 8 };

int command_bench(const command_line *a)
{
    static char path[PROGRAM_PATH_SIZE], name[] = "alpenglow-bench", quick[] = "--quick";
    static char markdown[] = "--markdown", scene[] = "--scene";
    static char room[64], scene_name[PROGRAM_PATH_SIZE];
    char *words[WORD_LIMIT] = {name};
    int count = 1;
    if (!program_find_beside(".", name, path) &&
        !program_find_beside(ALP_BENCH_FOLDER, name, path)) {
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
    return program_run(path, words);
}
