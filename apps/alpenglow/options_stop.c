// SPDX-License-Identifier: MIT
// Rows of the table of options: how well a bake is done, and what ends it.
#include "option_parts.h"

static const option rows[] = {
    {.id = OPTION_QUALITY,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_CHOICE,
     .name = "--quality",
     .value = "preview|medium|high",
     .choices = "preview|medium|high",
     .help = "The same as --error 4, 1 or 0.4."},
    {.id = OPTION_ERROR,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_REAL,
     .name = "--error",
     .value = "PCT",
     .minimum = 0.01,
     .maximum = 100.0,
     .unit = "percent",
     .help = "Bake in rounds of more and more rays until the stated error (root mean square of the "
             "standard errors, over the mean of the map) is at most this, and its 99th percentile "
             "at most four times this. --ao-samples is then the most rays a texel may get, 65536 "
             "when it is not given. Half the error takes about 2.7 times the rays. Light that "
             "bounces, gathered by rays, is held to both too, and goes for 1 percent with neither "
             "this nor --samples; half the error takes four times the rays."},
    {.id = OPTION_TIME_LIMIT,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_REAL,
     .name = "--time-limit",
     .value = "S",
     .minimum = 0.001,
     .maximum = 1e9,
     .unit = "seconds",
     .help = "End sampling after this time with what there is. Such a bake is not reproducible, "
             "says so, and states the error it has. Light keeps the rounds that were whole; "
             "with occlusion it has half of the time, and what occlusion leaves. Without --error "
             "it uses all of it. Not with --ao-bleed, nor with light by hemicubes, by paths or "
             "without bounces, which are baked in one go."},
    {.id = OPTION_MEMORY_LIMIT,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_SIZE,
     .name = "--memory-limit",
     .value = "SIZE",
     .minimum = 1048576.0,
     .maximum = 1e15,
     .unit = "bytes; K, M and G stand for 1024, 1024^2 and 1024^3",
     .help =
         "Fail if the bake would hold more than this; the message names the stage. Maps that "
         "cannot fit fail before any ray is traced. The scene and the ray tracer's structure are "
         "not counted. Without it: nine tenths of the machine's memory. Light keeps its rays "
         "between passes in what is left, else it traces them again."},
    {.id = OPTION_ADAPTIVE,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_REAL,
     .name = "--adaptive",
     .value = "A|auto|off",
     .minimum = 0.01,
     .maximum = 0.9999,
     .choices = "auto|off",
     .initial = "auto",
     .help =
         "Which texels are interpolated instead of traced. auto: those between traced ones that "
         "agree within their noise; no error is added that the noise does not hide. A number: "
         "those whose neighbours d texels apart differ by no more than 1 - A^d; 0.5 is a draft, "
         "0.98 careful. off: none. Of light it is bounced light that is interpolated, by auto for "
         "any number."},
    {.id = OPTION_STITCH,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_CHOICE,
     .name = "--stitch",
     .value = "on|off",
     .choices = "off|on",
     .initial = "on",
     .help = "on: values beside seams are moved by least squares until both sides show the same, "
             "across charts and from one object to the next where they touch and their normals "
             "agree. Those of noisy texels are moved first; away from seams nothing changes. off: "
             "the steps at seams are told alone."},
    {.id = OPTION_KEEP_PARTIAL,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_FLAG,
     .name = "--keep-partial",
     .help = "Ctrl-C ends sampling and writes what there is, instead of nothing; exit code 130. "
             "Light has nothing before its first round is whole, and is not denoised any more."},
};

const option_part option_part_stop = {rows, sizeof rows / sizeof *rows};
