// SPDX-License-Identifier: MIT
// alpenglow view: runs alpenglow-view, a program of its own, because it needs OpenGL and the rest
// of the command does not.
#include "commands/commands.h"
#include "printing/messages.h"
#include "programs.h"

#include <string.h>

int command_view(const command_line *a)
{
    static char path[PROGRAM_PATH_SIZE], name[] = "alpenglow-view";
    if (!program_find_beside(".", name, path) && !program_find_on_path(name, path)) {
        return failure("alpenglow-view is neither beside this program nor on PATH; install the "
                       "package alpenglow-viewer, or libepoxy-dev and libegl-dev and build with "
                       "ALP_BUILD_VIEWER=ON");
    }
    char **words = allocate_or_exit(NULL, ((size_t)a->word_count + 2) * sizeof *words);
    words[0] = name;
    memcpy(words + 1, a->words, (size_t)a->word_count * sizeof *words);
    words[a->word_count + 1] = NULL;
    return program_run(path, words); // only after a failure: the program ends, and so does this
}
