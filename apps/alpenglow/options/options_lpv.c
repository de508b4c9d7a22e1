// SPDX-License-Identifier: MIT
// Rows of the table of options: light propagation volumes.
#include "options/option_parts.h"

#define VOLUME_COMMANDS (IN_SAMPLE | IN_RENDER)

static const option rows[] = {
    {.id = OPTION_GRID,
     .commands = VOLUME_COMMANDS,
     .group = GROUP_VOLUME,
     .kind = KIND_WHOLE,
     .name = "--grid",
     .value = "N",
     .minimum = 1,
     .maximum = 512,
     .unit = "cells",
     .initial = "32",
     .help = "Cells along each side of a grid. Memory grows with the cube of N, to some 40 GB for "
             "512."},
    {.id = OPTION_CELL,
     .commands = IN_SAMPLE | IN_RENDER,
     .group = GROUP_VOLUME,
     .kind = KIND_REAL,
     .name = "--cell",
     .value = "M|auto",
     .choices = "auto",
     .minimum = 1e-4,
     .maximum = 1e6,
     .unit = "metres",
     .initial = "auto",
     .help = "lpv: side of a cell of the finest grid. auto: the coarsest grid holds the scene.\n"
             "ambience: distance of anchors at the finest level. auto: 1 m, or as much as lets a "
             "third of the anchors fill a small scene."},
    {.id = OPTION_CASCADES,
     .commands = VOLUME_COMMANDS,
     .group = GROUP_VOLUME,
     .kind = KIND_WHOLE,
     .name = "--cascades",
     .value = "N",
     .minimum = 1,
     .maximum = 8,
     .unit = "grids",
     .initial = "1",
     .help = "Grids inside each other. The cells of each are twice as large as those of the one "
             "before. In a picture, several grids follow the camera."},
    {.id = OPTION_ITERATIONS,
     .commands = VOLUME_COMMANDS,
     .group = GROUP_VOLUME,
     .kind = KIND_WHOLE,
     .name = "--iterations",
     .value = "N|auto",
     .choices = "auto",
     .minimum = 1,
     .maximum = 4096,
     .unit = "steps",
     .initial = "auto",
     .help = "Steps that light travels, a cell each. auto: --grid for one grid, 8 for several."},
    {.id = OPTION_MODE,
     .commands = VOLUME_COMMANDS,
     .group = GROUP_VOLUME,
     .kind = KIND_CHOICE,
     .name = "--mode",
     .value = "accurate|conformance",
     .choices = "accurate|conformance",
     .initial = "accurate",
     .help = "Direction of light in the next cell.\n"
             "accurate: the one in which it travelled.\n"
             "conformance: the normal of the face that it met, as published in 2010."},
    {.id = OPTION_BLOCKERS,
     .commands = VOLUME_COMMANDS,
     .group = GROUP_VOLUME,
     .kind = KIND_CHOICE,
     .name = "--blockers",
     .value = "points|views|off",
     .choices = "points|views|off",
     .initial = "points",
     .help = "Surfaces that stop light on its way.\n"
             "points: all, as points spread over their area.\n"
             "views: those that lamps and the camera of a picture see, as in a renderer on a "
             "GPU.\n"
             "off: none. Light goes through walls and is reflected once."},
};

const option_part option_part_lpv = {rows, sizeof rows / sizeof *rows};
