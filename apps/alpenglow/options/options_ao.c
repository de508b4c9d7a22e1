// SPDX-License-Identifier: MIT
// Rows of the table of options: ambient occlusion.
#include "options/option_parts.h"

static const option rows[] = {
    {.id = OPTION_AO_SAMPLES,
     .commands = RAY_COMMANDS | IN_VIEW,
     .group = GROUP_AO,
     .kind = KIND_WHOLE,
     .name = "--ao-samples",
     .value = "N",
     .minimum = 1,
     .maximum = 1048576,
     .unit = "rays per point",
     .initial = "512",
     .help = "Rays per point, rounded up to a multiple of 4. Time grows with N. The "
             "standard error of a texel is at most 0.5 / sqrt(N), and mostly far less. "
             "Powers of two are best."},
    {.id = OPTION_AO_DISTANCE,
     .commands = RAY_COMMANDS | IN_VIEW,
     .group = GROUP_AO,
     .kind = KIND_REAL,
     .name = "--ao-distance",
     .value = "M|auto|inf",
     .choices = "auto|inf",
     .minimum = 1e-6,
     .maximum = 1e9,
     .unit = "metres",
     .initial = "auto",
     .help = "Distance limit of occlusion. Shorter rays are slightly faster.\n"
             "auto: 20 % of the diagonal of the scene's bounding box.\n"
             "inf: no limit."},
    {.id = OPTION_AO_FALLOFF,
     .commands = RAY_COMMANDS | IN_VIEW,
     .group = GROUP_AO,
     .kind = KIND_CHOICE,
     .name = "--ao-falloff",
     .value = "none|linear|smooth|exp",
     .choices = "none|linear|smooth|exp",
     .initial = "smooth",
     .help = "Occlusion by a hit at t = distance / limit. With --ao-distance inf only "
             "none applies.\n"
             "none: 1\n"
             "linear: 1 - t\n"
             "smooth: (1 - t)^2 (1 + 2t)\n"
             "exp: e^-4t, shifted to reach 0 at the limit"},
    {.id = OPTION_AO_CONE,
     .commands = RAY_COMMANDS | IN_VIEW,
     .group = GROUP_AO,
     .kind = KIND_REAL,
     .name = "--ao-cone",
     .value = "DEG",
     .minimum = 1e-3,
     .maximum = 90,
     .unit = "degrees",
     .initial = "90",
     .help = "Half-angle of the cone of rays about the normal; 90 is the whole "
             "hemisphere."},
    {.id = OPTION_AO_DISTRIBUTION,
     .commands = RAY_COMMANDS | IN_VIEW,
     .group = GROUP_AO,
     .kind = KIND_CHOICE,
     .name = "--ao-distribution",
     .value = "cosine|uniform",
     .choices = "cosine|uniform",
     .initial = "cosine",
     .help = "Distribution of the rays.\n"
             "cosine: as uniform light from the sky reaches a matte surface.\n"
             "uniform: equal in all directions."},
    {.id = OPTION_AO_SELF,
     .commands = IN_BAKE,
     .group = GROUP_AO,
     .kind = KIND_FLAG,
     .name = "--ao-self",
     .help = "Bake every object as if it were alone. An object is a node with its "
             "whole mesh; nodes of one mesh share a map. --ao-distance auto is then 20 "
             "% of the diagonal of the object's own box. Not with --occluders or "
             "--atlas vertex."},
    {.id = OPTION_ONE_SIDED,
     .commands = RAY_COMMANDS | IN_VIEW,
     .group = GROUP_AO,
     .kind = KIND_FLAG,
     .name = "--one-sided",
     .help = "Rays pass single-sided materials from behind. Default: every surface "
             "occludes from both sides."},
    {.id = OPTION_AO_BLEED,
     .commands = IN_BAKE,
     .group = GROUP_AO,
     .kind = KIND_FLAG,
     .name = "--ao-bleed",
     .help = "Also bake coloured obscurance to --maps-dir. In it, an occluding surface "
             "counts with its colour instead of black. Linear RGB: obscurance.exr and "
             "obscurance.png. The map in OUT stays without colour, as glTF requires. "
             "Every texel traces its own rays, as many as a traced texel of ao, at two "
             "to four times the cost."},
    {.id = OPTION_EXISTING_AO,
     .commands = IN_BAKE,
     .group = GROUP_AO,
     .kind = KIND_CHOICE,
     .name = "--existing-ao",
     .value = "replace|multiply|keep",
     .choices = "replace|multiply|keep",
     .initial = "replace",
     .help = "Treatment of an occlusion map that a material already has.\n"
             "replace: the new map replaces it.\n"
             "multiply: new times old replaces it.\n"
             "keep: the material keeps its own."},
    {.id = OPTION_AO_INTO,
     .commands = IN_BAKE,
     .group = GROUP_AO,
     .kind = KIND_CHOICE,
     .name = "--ao-into",
     .value = "separate|orm",
     .choices = "separate|orm",
     .initial = "separate",
     .help = "Destination of a material's occlusion.\n"
             "separate: a map with its own coordinate set.\n"
             "orm: the red channel of the image of roughness and metalness (or "
             "occlusion). Its size, coordinates and other channels stay; a JPEG "
             "becomes a PNG. A material whose image is tiled or used in several places "
             "gets a separate map, with a warning."},
};

const option_part option_part_ao = {rows, sizeof rows / sizeof *rows};
