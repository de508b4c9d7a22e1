// SPDX-License-Identifier: MIT
// Rows of the table of options: outputs.
#include "options/option_parts.h"

static const option rows[] = {
    {.id = OPTION_OUTPUT,
     .commands = IN_BAKE,
     .common = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "-o",
     .alias = "--output",
     .value = "OUT.glb|OUT.gltf|OUT.dae|OUT.obj",
     .help = "The baked scene. A .gltf has its buffers and images beside it, an .obj "
             "its .mtl and images, a .dae its images. A .dae needs a SCENE of COLLADA. "
             "For OUT.json and OUT.babylon see --lightmap-as. -o may be left out before the name. "
             "Default, without --maps-dir: the name of SCENE with .baked before its ending, in the "
             "current folder."},
    {.id = OPTION_OUTPUT,
     .commands = IN_RENDER,
     .common = IN_RENDER,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "-o",
     .alias = "--output",
     .value = "IMAGE.png|IMAGE.exr|IMAGE.hdr",
     .help = "The picture, required. .png: 8-bit sRGB. .exr: linear float, alpha is "
             "the share of surface. .hdr: linear, without alpha."},
    {.id = OPTION_OUTPUT,
     .commands = IN_PROBES,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "-o",
     .alias = "--output",
     .value = "OUT.probes.json",
     .help = "The probes, required. OUT.probes.ktx2 beside it holds the light, and "
             "OUT.probes.moments.ktx2 the distances."},
    {.id = OPTION_OUTPUT,
     .commands = IN_MERGE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "-o",
     .alias = "--output",
     .value = "OUT",
     .help = "Write the asset (.glb, .gltf, .dae, .obj, .json, .babylon) or the folder of maps (a "
             "name without ending, or with a slash at its end) here, and none of the bake's own "
             "outputs."},
    {.id = OPTION_OUTPUT,
     .commands = IN_WEB,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "-o",
     .alias = "--output",
     .value = "OUT.html",
     .help = "The page, required. It holds the scene, the files that the scene names, and three.js "
             "with its licence."},
    {.id = OPTION_OUTPUT,
     .commands = IN_SH,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "-o",
     .alias = "--output",
     .value = "IMAGE.hdr|IMAGE.exr|IMAGE.png",
     .help = "Irradiance by direction of the normal, W/m2 per channel, not divided by pi, never "
             "negative. 256 x 128 pixels. .hdr, .exr: linear. .png: 8-bit sRGB with automatic "
             "exposure."},
    {.id = OPTION_MAPS,
     .commands = IN_BAKE,
     .common = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_LIST,
     .name = "--maps",
     .value = "LIST",
     .example = "light",
     .choices = "ao|bent|light|sh|direction|probes",
     .synonyms = "lightmap=light|lightmaps=light|lighting=light|occlusion=ao|ambient-occlusion=ao",
     .initial = "ao",
     .help = "Maps to bake, with commas between: ao, light and others. An option that only light "
             "has, such as --sky, --sun or --bounces, "
             "stands for light. OUT holds ao and light; all others go to --maps-dir alone.\n"
             "ao: ambient occlusion, 1 open, 0 closed.\n"
             "bent: bent normals, the mean open direction in world space, from the "
             "same rays.\n"
             "light: irradiance, W/m2 per channel, direct and bounced (--gather), "
             "without albedo, not divided by pi. Blended and transmissive surfaces "
             "filter it.\n"
             "sh: light by direction for normal-mapped surfaces, spherical harmonics "
             "of two bands; needs light.\n"
             "direction: the mean direction of light in world space; needs light.\n"
             "probes: light probes for everything that moves (--spacing, --bounds); needs "
             "light, and shares its solution."},
    {.id = OPTION_MAPS_FOLDER,
     .commands = IN_BAKE,
     .common = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--maps-dir",
     .value = "DIR",
     .example = "maps",
     .help = "Folder for each map as files, made if missing. Float RGBA, A is "
             "coverage, first row v = 0. Further pages are ao.1.exr and so on.\n"
             "ao: ao.exr, ao.png, ao.error.exr (standard error of each texel), "
             "ao.sampling.png (red traced, green interpolated, blue filled)\n"
             "bent: bent.exr (unit vectors), bent.png (n / 2 + 1/2)\n"
             "light: irradiance.exr, irradiance.error.exr\n"
             "sh: sh.0.exr to sh.3.exr (of 1, y, z, x)\n"
             "direction: direction.exr\n"
             "probes: scene.probes.json, .ktx2 and .moments.ktx2\n"
             "--ao-bleed: obscurance.exr, obscurance.png"},
    {.id = OPTION_MAPS_FOLDER,
     .commands = IN_WEB,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--maps-dir",
     .value = "DIR",
     .example = "maps",
     .help = "Folder of bake --layers --maps-dir. The page holds the maps of single lights in it, "
             "irradiance.NAME.exr, and dims each light. BAKED must hold light as a map "
             "(--lightmap-as moz or extras)."},
    {.id = OPTION_PROBES,
     .commands = IN_WEB,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--probes",
     .value = "FILE.probes.json",
     .help =
         "Grid of probes, as alpenglow probes writes it (sh9 or sh4). They light a white sphere "
         "that can be dragged through the scene."},
    {.id = OPTION_VOLUME,
     .commands = IN_WEB,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--volume",
     .value = "FILE.lpv.json",
     .help = "Light in space, as alpenglow lpv --volume writes it. The page shows its slices, at a "
             "place that a slider sets."},
    {.id = OPTION_REPORT,
     .commands = IN_WEB,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--report",
     .value = "REPORT.html",
     .help =
         "Put a link to the page into this report of bake --report, which lies in the folder of "
         "OUT.html. A link that web put there before is replaced."},
    {.id = OPTION_MAPS_AS,
     .commands = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_CHOICE,
     .name = "--maps-as",
     .value = "exr|exr16|hdr|ktx2",
     .choices = "exr|exr16|hdr|ktx2",
     .initial = "exr",
     .help = "File format of --maps-dir; .png files stay. A page too bright for half "
             "floats is divided by a power of two, which the file states "
             "(alpenglowScale).\n"
             "exr: RGBA floats, ZIP.\n"
             "exr16: RGBA half floats, ZIP, half the size, 11 significant bits.\n"
             "hdr: Radiance RGBE, 8 bits and an exponent, without coverage. Not for "
             "bent, sh and direction, which have signs.\n"
             "ktx2: RGBA half floats, Zstandard."},
    {.id = OPTION_JSON,
     .commands = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--json",
     .value = "FILE",
     .help = "Write a report as JSON: scene, atlas, seconds, rays, memory, objects "
             "with their rectangles, warnings. With --gather paths, rays are paths of "
             "several rays each. - prints it instead of the summary."},
    {.id = OPTION_REPORT,
     .commands = IN_BAKE,
     .common = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--report",
     .value = "OUT.html",
     .help = "Write a report as one HTML page: figures, a picture of the scene, warnings, "
             "pictures of the maps and their errors, time of each stage, objects on the atlas. It "
             "loads nothing and runs no script. It has the first 16 pages of an atlas. It links "
             "a page of alpenglow web beside it: the one that the replaced report linked, else "
             "the one with the name of -o, OUT.html for OUT.glb."},
    {.id = OPTION_JSON,
     .commands = IN_COMPARE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--json",
     .value = "FILE",
     .help = "Write the figures as JSON. - prints it instead of the table."},
    {.id = OPTION_JSON,
     .commands = IN_INFO | IN_STATUS,
     .group = GROUP_OUTPUT,
     .kind = KIND_FLAG,
     .name = "--json",
     .value = "[-|FILE.json]",
     .help = "Print JSON instead of tables, or write it to a file. It has all findings; text has "
             "the first 8 of a kind, and the first 20 rows of a table."},
    {.id = OPTION_PICTURES,
     .commands = IN_INFO,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--pictures",
     .value = "DIR",
     .help = "Folder for pictures of the findings, made if missing.\n"
             "scene.png: the scene in even light. Red: normals that point to the back. "
             "Orange: backs of single-sided surfaces.\n"
             "uv0.png and so on: each set of texture coordinates, row 0 is v = 0. "
             "Every island has a colour. Red: overlapping triangles. Orange lines: "
             "triangles outside of the unit square.\n"
             "spot-CODE.png: the worst place of a kind of finding, ringed."},
    {.id = OPTION_HEATMAP,
     .commands = IN_COMPARE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--heatmap",
     .value = "PNG",
     .help = "Write a picture of |A - B| of two images. Black is 0, white is the 99th "
             "percentile and above, magenta is covered in one image only."},
    {.id = OPTION_FORCE,
     .commands = RAY_COMMANDS | IN_INFO | IN_COMPARE | IN_PROBES | IN_AMBIENCE | IN_LPV | IN_SH |
                 IN_VIEW | IN_STATUS | IN_MERGE | IN_WEB,
     .common = IN_BAKE | IN_RENDER,
     .group = GROUP_OUTPUT,
     .kind = KIND_FLAG,
     .name = "-f",
     .alias = "--force",
     .help = "Overwrite existing files. Default: an existing output stops the command "
             "before it starts."},
};

const option_part option_part_output = {rows, sizeof rows / sizeof *rows};
