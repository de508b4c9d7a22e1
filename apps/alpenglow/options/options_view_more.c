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
    {.id = OPTION_SAMPLES,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_WHOLE,
     .name = "--samples",
     .value = "N",
     .minimum = 1,
     .maximum = 65536,
     .unit = "paths per pixel",
     .initial = "16",
     .help = "Paths of reference for each picture, rounded up to a multiple of 16, with noise of 1 "
             "/ sqrt(N). Batches of 64 have seeds of their own, and are averaged."},
    {.id = OPTION_BESIDE,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--beside",
     .value = "MODE",
     .choices = VIEW_MODES,
     .help = "A second mode, as of --with, for the right part of the picture. Exposure, tone curve "
             "and white balance are those of --with."},
    {.id = OPTION_DIVIDER,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_REAL,
     .name = "--divider",
     .value = "F",
     .minimum = 0,
     .maximum = 1,
     .initial = "0.5",
     .help = "Place of the white line between the parts of --beside: 0 the left edge of the "
             "picture, 1 the right one. The line is one pixel wide. Linear pictures have alpha 0 "
             "there."},
    {.id = OPTION_SSAO,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--ssao",
     .value = "on|off",
     .choices = "off|on",
     .initial = "off",
     .help = "Screen-space ambient occlusion. It dims the light of fields and models of ambient "
             "light by surfaces that the picture shows near, and neither direct light nor "
             "emission."},
    {.id = OPTION_SSAO_RADIUS,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_REAL,
     .name = "--ssao-radius",
     .value = "R|auto",
     .choices = "auto",
     .minimum = 1e-6,
     .maximum = 1e6,
     .unit = "metres",
     .initial = "auto",
     .help = "Farthest surface that dims (--ssao on).\n"
             "auto: a twentieth of the diagonal of the scene."},
};

const option_part option_part_view_more = {rows, sizeof rows / sizeof *rows};
