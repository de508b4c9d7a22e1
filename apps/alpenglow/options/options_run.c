// SPDX-License-Identifier: MIT
// Rows of the table of options: bench, and the run of a command.
#include "options/option_parts.h"

static const option rows[] = {
    {.id = OPTION_QUICK,
     .commands = IN_BENCH,
     .group = GROUP_WHAT,
     .kind = KIND_FLAG,
     .name = "--quick",
     .help = "Small sizes and one round, for a test of the program. The figures have "
             "no meaning."},
    {.id = OPTION_BENCH_SCENE,
     .commands = IN_BENCH,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--scene",
     .value = "SCENE",
     .help = "Scene to measure, instead of those of each bench. Built-in scenes "
             "include hills:N, a field of hills of N triangles."},
    {.id = OPTION_MARKDOWN,
     .commands = IN_BENCH,
     .group = GROUP_OUTPUT,
     .kind = KIND_FLAG,
     .name = "--markdown",
     .help = "Print tables as Markdown with their captions, as in "
             "docs/measured/speed.md."},

    {.id = OPTION_SEED,
     .commands = LIGHT_COMMANDS,
     .group = GROUP_RUN,
     .kind = KIND_WHOLE,
     .name = "--seed",
     .value = "N",
     .minimum = 0,
     .maximum = 9007199254740992.0,
     .initial = "0",
     .help = "Seed of the noise. The same seed gives the same bits for any number of "
             "threads."},
    {.id = OPTION_THREADS,
     .commands = LIGHT_COMMANDS | IN_MERGE,
     .group = GROUP_RUN,
     .kind = KIND_WHOLE,
     .name = "--threads",
     .value = "N|auto",
     .choices = "auto",
     .minimum = 1,
     .maximum = 1024,
     .initial = "auto",
     .help = "Number of threads, which changes the time and never the result. auto: "
             "one per core."},
    {.id = OPTION_PROGRESS,
     .commands = LIGHT_COMMANDS,
     .group = GROUP_RUN,
     .kind = KIND_CHOICE,
     .name = "--progress",
     .value = "auto|plain|json|off",
     .choices = "auto|plain|json|off",
     .initial = "auto",
     .help = "Progress on standard error.\n"
             "auto: one updating line on a terminal, else a line every 5 seconds.\n"
             "plain: a line at every stage and every 5 seconds.\n"
             "json: one object a line.\n"
             "off: none."},
    {.id = OPTION_WARNINGS_AS_ERRORS,
     .commands = LIGHT_COMMANDS,
     .group = GROUP_RUN,
     .kind = KIND_FLAG,
     .name = "--warnings-as-errors",
     .help = "Stop at the first warning and exit with 1."},
    {.id = OPTION_QUIET,
     .commands = SCENE_COMMANDS | IN_COMPARE | IN_MERGE | IN_WEB,
     .group = GROUP_RUN,
     .kind = KIND_FLAG,
     .name = "-q",
     .alias = "--quiet",
     .help = "No summary, notes or progress. Warnings and errors stay, and so do the "
             "results of info and compare."},

    {.id = OPTION_HELP,
     .commands = RAY_COMMANDS,
     .group = GROUP_RUN,
     .kind = KIND_FLAG,
     .name = "-h",
     .alias = "--help",
     .help = "Print the options that people use. --help all: every option, in full."},
    {.id = OPTION_HELP,
     .commands = (SCENE_COMMANDS & ~RAY_COMMANDS) | IN_COMPARE | IN_SH | IN_BENCH | IN_STATUS |
                 IN_MERGE | IN_WEB,
     .group = GROUP_RUN,
     .kind = KIND_FLAG,
     .name = "-h",
     .alias = "--help",
     .help = "Print help: every option, in full."},
};

const option_part option_part_run = {rows, sizeof rows / sizeof *rows};
