// SPDX-License-Identifier: MIT
// Rows of the table of options: view, beyond a picture by one mode.
#include "options/option_parts.h"

static const option rows[] = {
    {.id = OPTION_CAPTURE,
     .commands = IN_VIEW,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--capture",
     .value = "X,Y,Z",
     .help = "Instead of a picture: print nine spherical harmonics of the light at this point, in "
             "metres. The mode draws a cube map of 6 x 256 x 256 pixels. Disks of suns are left "
             "out."},
};

const option_part option_part_view_more = {rows, sizeof rows / sizeof *rows};
