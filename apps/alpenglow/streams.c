// SPDX-License-Identifier: MIT
#include "streams.h"

#include "options/options.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <unistd.h>

void streams_open(void)
{
    for (int i = STDIN_FILENO; i <= STDERR_FILENO; i++) {
        if (fcntl(i, F_GETFD) < 0) {
            (void)!open("/dev/null", i == STDIN_FILENO ? O_WRONLY : O_RDONLY);
        }
    }
    signal(SIGXFSZ, SIG_IGN);
}

int streams_close(int code)
{
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "alpenglow: cannot write to standard output\n");
        code = code == EXIT_DONE ? EXIT_FAILED : code;
    }
    return code;
}
