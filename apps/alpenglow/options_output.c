// SPDX-License-Identifier: MIT
// Rows of the table of options: what is written, and where.
#include "option_parts.h"

static const option rows[] = {
    {.id = OPTION_OUTPUT,
     .commands = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "-o",
     .alias = "--output",
     .value = "OUT.glb|OUT.gltf|OUT.dae|OUT.obj",
     .help = "The baked scene (OUT.json, OUT.babylon: see --lightmap-as). A .gltf gets its buffers "
             "and images beside it, an .obj its .mtl and images. Without -o, "
             "--maps-dir must be given. A .dae, with its images beside it, is written where SCENE "
             "is COLLADA."},
    {.id = OPTION_OUTPUT,
     .commands = IN_RENDER,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "-o",
     .alias = "--output",
     .value = "IMAGE.png|IMAGE.exr|IMAGE.hdr",
     .help = "The picture: .png 8-bit sRGB, .exr linear float with alpha = a surface is seen, "
             ".hdr linear without alpha. Needed."},
    {.id = OPTION_MAPS,
     .commands = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_LIST,
     .name = "--maps",
     .value = "LIST",
     .choices = "ao|bent|light|sh|direction",
     .later_choices = "probes",
     .initial = "ao",
     .help =
         "What to bake. ao: the ambient occlusion map (1 open, 0 closed). bent: bent normals, "
         "the mean open direction in world space, from the same rays. light: irradiance, W/m2 "
         "per channel, not divided by pi, without albedo, direct and bounced (--gather); "
         "blended and transmissive surfaces let it through in part, in their colour. sh: light "
         "by direction for normal-mapped surfaces, spherical harmonics of two bands; direction: "
         "the mean direction of light in world space; both need light. "
         "What is not ao goes to --maps-dir alone, and -o needs ao, or light and "
         "--lightmap-as."},
    {.id = OPTION_MAPS_FOLDER,
     .commands = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--maps-dir",
     .value = "DIR",
     .help = "Also write each map there: ao.exr (float RGBA, A is coverage, first row v = 0), "
             "ao.png, ao.error.exr (standard error of each texel), ao.sampling.png (red traced, "
             "green interpolated, blue filled from beside); bent.exr (unit vectors) and bent.png "
             "(n / 2 + 1/2); irradiance.exr and irradiance.error.exr; sh.0.exr to "
             "sh.3.exr (of 1, y, z, x); direction.exr; obscurance.exr and obscurance.png; further "
             "pages ao.1.exr and so on. DIR is made if missing."},
    {.id = OPTION_MAPS_AS,
     .commands = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_CHOICE,
     .name = "--maps-as",
     .value = "exr|exr16|hdr|ktx2",
     .choices = "exr|exr16|hdr|ktx2",
     .initial = "exr",
     .help = "What the .exr files of --maps-dir are; the .png stay. exr: RGBA floats, ZIP, the "
             "values as they are. exr16: half floats, half the size, 11 bits of each number. hdr: "
             "Radiance RGBE, .hdr in the place of .exr, 8 bits and an exponent; without coverage, "
             "and not for bent, sh and direction, which have signs. ktx2: RGBA half floats, "
             "Zstandard, .ktx2. A page too bright for half floats is stored over a power of two, "
             "which the file states (alpenglowScale)."},
    {.id = OPTION_JSON,
     .commands = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--json",
     .value = "FILE",
     .help = "Write a report: scene, atlas, seconds, rays (of --maps light with bounces paths, of "
             "several rays each), memory, objects with their rectangles, warnings. - is standard "
             "output, instead of the summary."},
    {.id = OPTION_REPORT,
     .commands = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--report",
     .value = "OUT.html",
     .help = "Write a page to read: figures, warnings, pictures of the maps and of their errors, "
             "time per stage, where the objects lie. One file, which loads nothing and runs no "
             "script; the first 16 pages of an atlas."},
    {.id = OPTION_JSON,
     .commands = IN_COMPARE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--json",
     .value = "FILE",
     .help = "Write the numbers as JSON. - is standard output, instead of the table."},
    {.id = OPTION_JSON,
     .commands = IN_INFO,
     .group = GROUP_OUTPUT,
     .kind = KIND_FLAG,
     .name = "--json",
     .help = "Print JSON instead of tables; all findings, where text tells the first 8 of a kind."},
    {.id = OPTION_PICTURES,
     .commands = IN_INFO,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--pictures",
     .value = "DIR",
     .help =
         "Also draw there: scene.png, the scene in even light (red: normals that look to the "
         "back, orange: backs of single-sided surfaces); uv0.png and so on, each set of texture "
         "coordinates, row 0 is v = 0 (islands in colours of their own, red where triangles "
         "overlap, orange lines outside of the unit square); spot-CODE.png, the worst place of a "
         "kind of finding, ringed. DIR is made if missing."},
    {.id = OPTION_HEATMAP,
     .commands = IN_COMPARE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--heatmap",
     .value = "PNG",
     .help = "Write a picture of |A - B| of two images: black 0, white the 99th percentile and "
             "above, magenta "
             "covered in one only."},
    {.id = OPTION_FORCE,
     .commands = RAY_COMMANDS | IN_INFO | IN_COMPARE,
     .group = GROUP_OUTPUT,
     .kind = KIND_FLAG,
     .name = "-f",
     .alias = "--force",
     .help = "Overwrite existing files. Without it an existing output stops the command before "
             "it starts."},
};

const option_part option_part_output = {rows, sizeof rows / sizeof *rows};
