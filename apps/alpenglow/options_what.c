// SPDX-License-Identifier: MIT
// Rows of the table of options: what is baked, or compared.
#include "option_parts.h"

static const option rows[] = {
    {.id = OPTION_SIZE,
     .commands = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_WHOLE,
     .name = "--size",
     .value = "N",
     .minimum = 1,
     .maximum = 16384,
     .unit = "texels",
     .initial = "1024",
     .help = "Side of a page of the atlas. Time and memory grow with its square."},
    {.id = OPTION_SIZE,
     .commands = IN_RENDER,
     .group = GROUP_LIGHT,
     .kind = KIND_WHOLE,
     .name = "--size",
     .value = "N",
     .minimum = 1,
     .maximum = 16384,
     .unit = "texels",
     .initial = "512",
     .help = "Of --with lightmap, radiosity and hemicube: side of a page of the atlas. Time and "
             "memory grow "
             "with its square."},
    {.id = OPTION_TEXELS_PER_METRE,
     .commands = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_REAL,
     .name = "--texels-per-metre",
     .value = "D|auto",
     .choices = "auto",
     .minimum = 1e-6,
     .maximum = 1e6,
     .unit = "texels per metre",
     .initial = "auto",
     .help = "Density of the map; pages are added as needed. auto: the highest density at which "
             "all fits one page. Time grows with its square."},
    {.id = OPTION_ATLAS,
     .commands = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_CHOICE,
     .name = "--atlas",
     .value = "auto|keep|charts|vertex|blend",
     .choices = "auto|keep|charts|vertex|blend",
     .initial = "auto",
     .help = "keep: use the scene's second UV set, which must lie in range and not overlap. "
             "charts: unwrap anew. auto: keep where it is valid, else charts. vertex: no map, but "
             "a value at each vertex, the best for linear interpolation over its triangles; "
             "options of maps, of their error and of stopping have no meaning then and are "
             "refused. Warns where triangles are too large for it. blend: charts that overlap "
             "and three coordinate sets, for a shader that blends them by the normal and shows no "
             "seams (docs/blend.md)."},
    {.id = OPTION_ATLAS,
     .commands = IN_RENDER,
     .group = GROUP_WHAT,
     .kind = KIND_CHOICE,
     .name = "--atlas",
     .value = "auto|keep|charts|blend|average",
     .choices = "auto|keep|charts|blend|average",
     .initial = "auto",
     .help = "Of --with lightmap: the map's layout, as in bake. average: the charts of blend, each "
             "that a triangle is in counting alike, for comparison."},
    {.id = OPTION_VERTEX_ATTRIBUTE,
     .commands = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_CHOICE,
     .name = "--vertex-attribute",
     .value = "color|occlusion",
     .choices = "color|occlusion",
     .initial = "color",
     .help = "Where --atlas vertex writes its values, 16 bits. color: COLOR_0, which viewers "
             "multiply into the base colour; colours that are there already are multiplied, "
             "alpha stays. occlusion: the attribute _OCCLUSION, for shaders that read it; "
             "COLOR_0 stays as it is."},
    {.id = OPTION_PADDING,
     .commands = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_WHOLE,
     .name = "--padding",
     .value = "N",
     .minimum = 0,
     .maximum = 64,
     .unit = "texels",
     .initial = "2",
     .help = "Free texels between neighbouring charts, filled with the nearest value. More keeps "
             "smaller mip levels clean, and leaves less of the page for charts."},
    {.id = OPTION_BLOCK,
     .commands = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_WHOLE,
     .name = "--block",
     .value = "N",
     .minimum = 1,
     .maximum = 64,
     .unit = "texels",
     .initial = "1",
     .help = "No block of N x N texels holds two charts, so that compressed textures keep them "
             "apart: 4 for BC and ETC, 4 to 12 for ASTC. Makes new charts."},
    {.id = OPTION_MIPS,
     .commands = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_WHOLE,
     .name = "--mips",
     .value = "N",
     .minimum = 0,
     .maximum = 8,
     .unit = "levels",
     .initial = "0",
     .help = "Keep charts so far apart that bilinear look-ups at the first N mip levels read no "
             "texel of another chart; --size must be a multiple of 2^N. Makes new charts."},
    {.id = OPTION_DENSITY,
     .commands = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--density",
     .value = "GLOB=FACTOR",
     .help =
         "Surfaces with more texels per metre than others, or fewer: patterns of names as in "
         "--only, or material:GLOB for names of materials, each with its factor in "
         "[0.001, 1000]; several with commas between, whose factors are multiplied, the product in "
         "the same range. Makes new charts."},
    {.id = OPTION_ONLY,
     .commands = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--only",
     .value = "GLOB",
     .help =
         "Bake only the surfaces whose node's name matches (its mesh's, where it has none; info "
         "lists them): * any characters, ? one, [a-z] one of these, [!a-z] one that is not; "
         "several patterns with commas between, and \\ before a comma or another sign that is "
         "meant. Each must match something. All other surfaces come out as they were, and "
         "still occlude. Not with --atlas vertex."},
    {.id = OPTION_OCCLUDERS,
     .commands = RAY_COMMANDS,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--occluders",
     .value = "GLOB",
     .help = "Only surfaces whose name matches occlude, patterns as in bake --only; rays pass all "
             "others."},
    {.id = OPTION_SCENE,
     .commands = SCENE_COMMANDS,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--scene",
     .value = "N|NAME",
     .help = "Which scene of a .gltf or .glb that holds several: its number from 0, or its name. "
             "Without it the one that viewers show first."},
    {.id = OPTION_ALLOW_OUTSIDE,
     .commands = SCENE_COMMANDS,
     .group = GROUP_WHAT,
     .kind = KIND_FLAG,
     .name = "--allow-outside",
     .help = "SCENE may name buffers, pictures and materials anywhere: by \"..\", absolute paths "
             "and file: addresses. Without it only what lies below its own folder is read."},
    {.id = OPTION_SCALE,
     .commands = IN_COMPARE,
     .group = GROUP_WHAT,
     .kind = KIND_REAL,
     .name = "--scale",
     .value = "S",
     .minimum = -1e9,
     .maximum = 1e9,
     .initial = "1",
     .help = "Multiply A by S first."},
    {.id = OPTION_MAX_RMSE,
     .commands = IN_COMPARE,
     .group = GROUP_WHAT,
     .kind = KIND_REAL,
     .name = "--max-rmse",
     .value = "X",
     .minimum = 0,
     .maximum = 1e9,
     .help = "Exit with 1 when rmse is above X, or when no pixel is covered in both."},
};

const option_part option_part_what = {rows, sizeof rows / sizeof *rows};
