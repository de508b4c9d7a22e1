// SPDX-License-Identifier: MIT
// Rows of the table of options: quality and limits.
#include "options/option_parts.h"

static const option rows[] = {
    {.id = OPTION_QUALITY,
     .commands = IN_BAKE,
     .common = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_CHOICE,
     .name = "--quality",
     .value = "preview|medium|high",
     .choices = "preview|medium|high",
     .help = "Preset of --error: preview is 4, medium is 1, high is 0.4."},
    {.id = OPTION_ERROR,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_REAL,
     .name = "--error",
     .value = "PCT",
     .minimum = 0.01,
     .maximum = 100.0,
     .unit = "percent",
     .help = "Wanted error: root mean square of the standard errors over the mean of "
             "the map. Rounds of more and more rays run until it is reached and the "
             "99th percentile is at most four times it. --ao-samples is then the limit "
             "of rays per texel, default 65536. Half the error takes about 2.7 times "
             "the rays of occlusion, and four times those of light. Light by --gather "
             "rays has a default of 1, unless --samples is given. That default also ends "
             "by a limit of rays, with the error that it has then."},
    {.id = OPTION_QUALITY,
     .commands = IN_RENDER,
     .common = IN_RENDER,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--quality",
     .value = "preview|medium|high",
     .choices = "preview|medium|high",
     .help = "Preset of --error: preview is 4, medium is 1, high is 0.4."},
    {.id = OPTION_ERROR,
     .commands = IN_RENDER,
     .group = GROUP_LIGHT,
     .kind = KIND_REAL,
     .name = "--error",
     .value = "PCT",
     .minimum = 0.01,
     .maximum = 100.0,
     .unit = "percent",
     .help = "Wanted error of the map that --with lightmap bakes, as in bake; instead of "
             "--texel-samples."},
    {.id = OPTION_TIME_LIMIT,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_REAL,
     .name = "--time-limit",
     .value = "S",
     .minimum = 0.001,
     .maximum = 1e9,
     .unit = "seconds",
     .help = "End sampling after this time, with the results so far. The bake states "
             "its error, and that it is not reproducible. Light keeps complete rounds; "
             "with occlusion it has half of the time, and the rest that occlusion "
             "leaves. Without --error all of the time is used. Not with --ao-bleed, "
             "light by hemicubes or paths, or light without bounces, which have no "
             "rounds."},
    {.id = OPTION_MEMORY_LIMIT,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_SIZE,
     .name = "--memory-limit",
     .value = "SIZE",
     .minimum = 1048576.0,
     .maximum = 1e15,
     .unit = "bytes; K, M and G stand for 1024, 1024^2 and 1024^3",
     .help = "Fail if the bake would hold more memory; the message names the stage. "
             "Maps that cannot fit fail before any ray is traced. The scene and the "
             "ray tracer's structure do not count. Default: nine tenths of the "
             "machine's memory. Light keeps the rays of its passes in the rest, or "
             "traces them again."},
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
     .help = "Interpolation of texels between traced ones; for light, of bounced "
             "light.\n"
             "auto: if the traced ones agree within their noise, so that the added "
             "error is below the noise.\n"
             "A: if traced texels d texels apart differ by at most 1 - A^d. 0.5 is a "
             "draft, 0.98 careful. For light the same as auto.\n"
             "off: every texel is traced."},
    {.id = OPTION_STITCH,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_CHOICE,
     .name = "--stitch",
     .value = "on|off",
     .choices = "off|on",
     .initial = "on",
     .help = "Agreement of both sides of a seam.\n"
             "on: values beside seams change by least squares until both sides agree, "
             "across charts and touching objects with equal normals. Noisy texels "
             "change most; away from seams nothing changes.\n"
             "off: the steps at seams are only reported."},
    {.id = OPTION_KEEP_PARTIAL,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_FLAG,
     .name = "--keep-partial",
     .help = "Write the results so far at Ctrl-C, instead of nothing; exit status 130. "
             "Light has no result before its first round ends, and is then not "
             "denoised."},
};

const option_part option_part_stop = {rows, sizeof rows / sizeof *rows};
