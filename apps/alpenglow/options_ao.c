// SPDX-License-Identifier: MIT
// Rows of the table of options: ambient occlusion.
#include "option_parts.h"

static const option rows[] = {
    {.id = OPTION_AO_SAMPLES,
     .commands = RAY_COMMANDS,
     .group = GROUP_AO,
     .kind = KIND_WHOLE,
     .name = "--ao-samples",
     .value = "N",
     .minimum = 1,
     .maximum = 1048576,
     .unit = "rays per point",
     .initial = "512",
     .help = "Time grows with N, which is rounded up to a multiple of 4. The standard error of a "
             "texel is at most 0.5 / sqrt(N), and with "
             "these samples mostly far less; powers of two serve best."},
    {.id = OPTION_AO_DISTANCE,
     .commands = RAY_COMMANDS,
     .group = GROUP_AO,
     .kind = KIND_REAL,
     .name = "--ao-distance",
     .value = "M|auto|inf",
     .choices = "auto|inf",
     .minimum = 1e-6,
     .maximum = 1e9,
     .unit = "metres",
     .initial = "auto",
     .help = "How far away a surface still occludes. auto: 20 % of the diagonal of the scene's "
             "bounding box. inf: no limit. Shorter rays are a little faster."},
    {.id = OPTION_AO_FALLOFF,
     .commands = RAY_COMMANDS,
     .group = GROUP_AO,
     .kind = KIND_CHOICE,
     .name = "--ao-falloff",
     .value = "none|linear|smooth|exp",
     .choices = "none|linear|smooth|exp",
     .initial = "smooth",
     .help = "How a hit at t = distance / limit occludes. none: 1; linear: 1 - t; smooth: "
             "(1 - t)^2 (1 + 2t); exp: e^-4t, brought to 0 at the limit. With --ao-distance inf "
             "only none has a meaning and is the default."},
    {.id = OPTION_AO_CONE,
     .commands = RAY_COMMANDS,
     .group = GROUP_AO,
     .kind = KIND_REAL,
     .name = "--ao-cone",
     .value = "DEG",
     .minimum = 1e-3,
     .maximum = 90,
     .unit = "degrees",
     .initial = "90",
     .help = "Half-angle of the cone of rays about the normal; 90 is the whole hemisphere."},
    {.id = OPTION_AO_DISTRIBUTION,
     .commands = RAY_COMMANDS,
     .group = GROUP_AO,
     .kind = KIND_CHOICE,
     .name = "--ao-distribution",
     .value = "cosine|uniform",
     .choices = "cosine|uniform",
     .initial = "cosine",
     .help = "cosine: as uniform light from the sky reaches a matte surface. uniform: every "
             "direction counts the same."},
    {.id = OPTION_AO_SELF,
     .commands = IN_BAKE,
     .group = GROUP_AO,
     .kind = KIND_FLAG,
     .name = "--ao-self",
     .help =
         "Every object, a node with its whole mesh, is baked as if it were alone, and all nodes "
         "with the same mesh share one map. --ao-distance auto is then 20 % of the diagonal of "
         "the object's own box. Not with --occluders or --atlas vertex."},
    {.id = OPTION_ONE_SIDED,
     .commands = RAY_COMMANDS,
     .group = GROUP_AO,
     .kind = KIND_FLAG,
     .name = "--one-sided",
     .help = "Rays pass single-sided materials from behind. Without it every surface occludes "
             "from both sides."},
    {.id = OPTION_AO_BLEED,
     .commands = IN_BAKE,
     .group = GROUP_AO,
     .kind = KIND_FLAG,
     .name = "--ao-bleed",
     .help = "Also bake coloured obscurance to --maps-dir: occlusion in which a surface that "
             "occludes counts with its colour instead of as black. Linear RGB, obscurance.exr and "
             "obscurance.png; the map in OUT stays without colour, as glTF wants it. Every texel "
             "gets as many rays of its own as a traced texel of ao, two to four times as slow."},
    {.id = OPTION_EXISTING_AO,
     .commands = IN_BAKE,
     .group = GROUP_AO,
     .kind = KIND_CHOICE,
     .name = "--existing-ao",
     .value = "replace|multiply|keep",
     .choices = "replace|multiply|keep",
     .initial = "replace",
     .help = "What happens to an occlusion map that a material has already: ours takes its "
             "place, ours times the old one does, or the material keeps its own."},
    {.id = OPTION_AO_INTO,
     .commands = IN_BAKE,
     .group = GROUP_AO,
     .kind = KIND_CHOICE,
     .name = "--ao-into",
     .value = "separate|orm",
     .choices = "separate|orm",
     .initial = "separate",
     .help = "Where the occlusion of a material goes. separate: a map of its own, with its own "
             "coordinate set. orm: the red channel of the image that holds its roughness and "
             "metalness (or occlusion), at that image's size and coordinates, the other channels "
             "unchanged; a material whose image is tiled or shared by several places gets a "
             "separate map and a warning. A JPEG becomes a PNG."},
};

const option_part option_part_ao = {rows, sizeof rows / sizeof *rows};
