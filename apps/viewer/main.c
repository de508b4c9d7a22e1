// SPDX-License-Identifier: MIT
// alpenglow-view: draws scenes by OpenGL. `alpenglow view` runs it with the same arguments.
#include "library.h"
#include "options/options.h"
#include "streams.h"
#include "view_run.h"

#include <stdlib.h>

static int run(int count, char **words)
{
    command_line parsed;
    if (arguments_ask_for_help(count, words) != HELP_NONE) {
        return help_print_command(COMMAND_VIEW, HELP_ALL);
    }
    int code = library_check();
    code = code == EXIT_DONE ? arguments_parse(COMMAND_VIEW, count, words, &parsed) : code;
    return code == EXIT_DONE ? view_run(&parsed) : code;
}

int main(int count, char **words)
{
    streams_open();
    // Mesa warns of each driver that it lacks. gl_context_open prints one line if none is left.
    setenv("EGL_LOG_LEVEL", "fatal", 0);
    return streams_close(run(count > 0 ? count - 1 : 0, words + 1));
}
