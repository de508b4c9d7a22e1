// SPDX-License-Identifier: MIT
// Rows of the table of options: scene, atlas and comparison.
#include "options/option_parts.h"

static const option rows[] = {
    {.id = OPTION_SIZE,
     .commands = IN_BAKE,
     .common = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_WHOLE,
     .name = "--size",
     .value = "N",
     .example = "1024",
     .sides = true,
     .minimum = 1,
     .maximum = 16384,
     .unit = "texels",
     .initial = "1024",
     .help = "Side of an atlas page, such as 1024 or 1k. Time and memory grow with its square."},
    {.id = OPTION_SIZE,
     .commands = IN_RENDER | IN_VIEW,
     .common = IN_RENDER,
     .group = GROUP_LIGHT,
     .kind = KIND_WHOLE,
     .name = "--size",
     .value = "N",
     .example = "1024",
     .sides = true,
     .minimum = 1,
     .maximum = 16384,
     .unit = "texels",
     .initial = "512",
     .help = "Side of an atlas page, for --with lightmap, radiosity and hemicube. Time "
             "and memory grow with its square."},
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
     .help = "Texel density; pages are added as needed. Time grows with its square.\n"
             "auto: the highest density at which everything fits on one page."},
    {.id = OPTION_ATLAS,
     .commands = IN_BAKE,
     .common = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_CHOICE,
     .name = "--atlas",
     .value = "auto|keep|charts|vertex|blend",
     .choices = "auto|keep|charts|vertex|blend",
     .initial = "auto",
     .help = "Layout of the maps.\n"
             "auto: keep if the second UV set is valid, else charts.\n"
             "keep: the scene's second UV set, inside [0, 1]. Overlaps on up to 1 % of its texels "
             "cause a warning.\n"
             "charts: new charts.\n"
             "vertex: no map, but a value at each vertex, fitted for linear "
             "interpolation over the triangles. Warns of triangles that are too large "
             "for it. Options of maps, errors and limits are refused.\n"
             "blend: overlapping charts in three coordinate sets, for a shader that "
             "blends them by the normal, without seams (docs/manual/blend.md)."},
    {.id = OPTION_ATLAS,
     .commands = IN_RENDER | IN_VIEW,
     .group = GROUP_WHAT,
     .kind = KIND_CHOICE,
     .name = "--atlas",
     .value = "auto|keep|charts|blend|average",
     .choices = "auto|keep|charts|blend|average",
     .initial = "auto",
     .help = "Layout of the map, for --with lightmap, as in bake.\n"
             "average: the charts of blend with equal weights, for comparison."},
    {.id = OPTION_STITCH,
     .commands = IN_RENDER | IN_VIEW,
     .group = GROUP_WHAT,
     .kind = KIND_CHOICE,
     .name = "--stitch",
     .value = "on|off",
     .choices = "off|on",
     .initial = "on",
     .help = "Stitch the map at its seams, for --with lightmap, as in bake."},
    {.id = OPTION_VERTEX_ATTRIBUTE,
     .commands = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_CHOICE,
     .name = "--vertex-attribute",
     .value = "color|occlusion",
     .choices = "color|occlusion",
     .initial = "color",
     .help = "Attribute for the values of --atlas vertex, 16 bits.\n"
             "color: COLOR_0, which viewers multiply into the base colour. Colours "
             "already there are multiplied; alpha stays.\n"
             "occlusion: _OCCLUSION, for custom shaders. COLOR_0 stays."},
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
     .help = "Free texels between neighbouring charts, filled with the nearest value. "
             "More keeps smaller mip levels clean, and leaves less of the page for "
             "charts."},
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
     .help = "Side of a block of texture compression. No block of N x N texels holds "
             "two charts. Use 4 for BC and ETC, 4 to 12 for ASTC. Makes new charts."},
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
     .help = "Mip levels to keep clean. Bilinear reads at the first N levels take no "
             "texel of another chart. --size must be a multiple of 2^N. Makes new "
             "charts."},
    {.id = OPTION_DENSITY,
     .commands = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--density",
     .value = "GLOB=FACTOR",
     .help = "Factors on the texel density of surfaces, in [0.001, 1000]. GLOB is a "
             "pattern of names as in --only, or material:GLOB for names of materials. "
             "Put commas between several. Factors of all matches are multiplied, in "
             "the same range. Makes new charts."},
    {.id = OPTION_ONLY,
     .commands = IN_BAKE,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--only",
     .value = "GLOB",
     .help = "Bake only surfaces whose name matches. A surface has the name of its "
             "node, else of its mesh; info lists them. * is any characters, ? one, "
             "[a-z] one of a set, [!a-z] one outside it. Put commas between patterns; "
             "\\ makes the next character literal. Each pattern must match. Other "
             "surfaces are written unchanged and still occlude. Not with --atlas "
             "vertex."},
    {.id = OPTION_OCCLUDERS,
     .commands = RAY_COMMANDS | IN_VIEW,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--occluders",
     .value = "GLOB",
     .help = "Only surfaces whose name matches occlude; rays pass all others. Patterns "
             "as in bake --only."},
    {.id = OPTION_SCENE,
     .commands = SCENE_COMMANDS,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--scene",
     .value = "N|NAME",
     .help = "Scene of a .gltf or .glb that holds several: its number from 0, or its "
             "name. Default: the scene that viewers open first."},
    {.id = OPTION_ANIMATION,
     .commands = SCENE_COMMANDS,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--animation",
     .value = "N|NAME",
     .initial = "0",
     .help =
         "Animation of a .gltf or .glb for --animation-time, and for flights of view: its name, "
         "or its number from 0; info lists them. none: a flight plays none."},
    {.id = OPTION_ANIMATION_TIME,
     .commands = SCENE_COMMANDS,
     .group = GROUP_WHAT,
     .kind = KIND_REAL,
     .name = "--animation-time",
     .value = "T",
     .minimum = 0,
     .maximum = 1e6,
     .unit = "seconds",
     .help =
         "Pose of the scene: nodes stand where the animation places them at this time. Default: "
         "as the file places them. A flight of view moves them on from frame to frame, and "
         "maps, probes, ambience and models of ambient light keep the light of this pose."},
    {.id = OPTION_ALLOW_OUTSIDE,
     .commands = SCENE_COMMANDS,
     .group = GROUP_WHAT,
     .kind = KIND_FLAG,
     .name = "--allow-outside",
     .help = "Allow SCENE to name files outside its own folder: by \"..\", absolute "
             "paths and file: addresses. Default: only files below its folder are "
             "read."},
    {.id = OPTION_SCALE,
     .commands = IN_COMPARE,
     .group = GROUP_WHAT,
     .kind = KIND_REAL,
     .name = "--scale",
     .value = "S",
     .minimum = -1e9,
     .maximum = 1e9,
     .initial = "1",
     .help = "Factor on A before the comparison."},
    {.id = OPTION_MAX_RMSE,
     .commands = IN_COMPARE,
     .group = GROUP_WHAT,
     .kind = KIND_REAL,
     .name = "--max-rmse",
     .value = "X",
     .minimum = 0,
     .maximum = 1e9,
     .help = "Exit with 1 if rmse is above X. Also if no pixel, or no point of two "
             "scenes, is covered in both."},
    {.id = OPTION_MAP,
     .commands = IN_COMPARE,
     .group = GROUP_WHAT,
     .kind = KIND_CHOICE,
     .name = "--map",
     .value = "ao|light",
     .choices = "ao|light",
     .help = "Map to compare, for two scenes. Default: ao if both have it, else light.\n"
             "ao: the occlusion textures.\n"
             "light: MOZ_lightmap or the file of extras.lightmap (.exr, .hdr), times "
             "its intensity; else the emission of materials with an emission texture. "
             "In the units of the file (--units)."},
    {.id = OPTION_CONVENTION,
     .commands = IN_SH | IN_VIEW,
     .group = GROUP_WHAT,
     .kind = KIND_CHOICE,
     .name = "--convention",
     .value = "three|filament|gltf|godot|unity|ambient-cube",
     .choices = "three|filament|gltf|godot|unity|ambient-cube",
     .initial = "three",
     .help = "Numbers to print, in the order of their reader; in view for --capture.\n"
             "three: LightProbe of three.js, radiance.\n"
             "filament: irradiance(3, sh), E / pi as a polynomial.\n"
             "gltf: irradianceCoefficients of EXT_lights_image_based.\n"
             "godot: LightmapGIData, radiance / pi.\n"
             "unity: SphericalHarmonicsL2, E / pi as a polynomial. Unity's axes are left-handed; "
             "the numbers are in ours.\n"
             "ambient-cube: six lines, the irradiance of +x -x +y -y +z -z."},
    {.id = OPTION_POINTS,
     .commands = IN_COMPARE,
     .group = GROUP_WHAT,
     .kind = KIND_WHOLE,
     .name = "--points",
     .value = "N",
     .minimum = 1,
     .maximum = 16777216,
     .initial = "262144",
     .help = "Number of points to compare, for two scenes. Each stands for an equal "
             "area of the surface."},
};

const option_part option_part_what = {rows, sizeof rows / sizeof *rows};
