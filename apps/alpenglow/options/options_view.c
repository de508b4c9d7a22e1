// SPDX-License-Identifier: MIT
// Rows of the table of options: view.
#include "options/option_parts.h"

static const option rows[] = {
    {.id = OPTION_OUTPUT,
     .commands = IN_VIEW,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "-o",
     .alias = "--output",
     .value = "IMAGE.png|IMAGE.exr|IMAGE.hdr",
     .help = "The picture. .png: 8-bit sRGB. .exr: linear float, alpha is 1 where there is a "
             "surface or a sky. .hdr: linear, without alpha."},
    {.id = OPTION_PICTURES,
     .commands = IN_VIEW,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--pictures",
     .value = "DIR",
     .help = "Folder for the pictures of a flight, made if missing: frame_0001.png and so on "
             "(--path)."},
    {.id = OPTION_WITH,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--with",
     .value = "MODE",
     .choices = VIEW_MODES,
     .help = "Light of the picture, required.\n"
             "none: emission alone.\n"
             "albedo: as render --with albedo.\n"
             "lightmap: as render --with lightmap.\n"
             "direct: light straight from lamps and suns, by shadow maps. Suns are points: their "
             "shadows are sharp. Panes that let half the light through or more cast no shadow, "
             "others a whole one.\n"
             "constant, hemisphere, ground-map, ambient-cube, environment: the models of ambient "
             "light, as of render, with light as of direct (--direct).\n"
             "probes, ambience, lpv: these fields, as of render, with light as of direct (--read, "
             "--direct). Along a flight the volume of ambience flies too, and that of lpv is lit "
             "again in each picture.\n"
             "ao: a baked map of occlusion, as render --with ao shows one.\n"
             "sh: a light map by direction, spherical harmonics of two bands, which reads normal "
             "maps.\n"
             "blend: as lightmap --atlas blend.\n"
             "reference: paths, as render --with reference (--samples)."},
    {.id = OPTION_DIRECT,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--direct",
     .value = "on|off",
     .choices = "off|on",
     .initial = "on",
     .help = "Light straight from lamps and suns, for fields, the models of ambient light "
             "and reference."},
    {.id = OPTION_READ,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--read",
     .value = "pixel|vertex|object",
     .choices = "pixel|vertex|object",
     .initial = "pixel",
     .help = "Places where probes, ambience and lpv are read.\n"
             "pixel: at every pixel, with its normal.\n"
             "vertex: at every vertex, for both sides of double-sided surfaces; interpolated "
             "between them.\n"
             "object: once an object, at the middle of its bounds, in twelve directions; nine "
             "spherical harmonics of these give every pixel the light of its normal."},
    {.id = OPTION_NORMAL_MAPS,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--normal-maps",
     .value = "on|off",
     .choices = "off|on",
     .initial = "on",
     .help = "Normal maps of materials, where light comes by direction: direct, the models of "
             "ambient light, sh, and fields (at vertices: direct light alone). render has none; "
             "neither has lightmap."},
    {.id = OPTION_PATH,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_TEXT,
     .name = "--path",
     .value = "FLIGHT.csv",
     .help =
         "Flight of the camera, instead of --camera; with --pictures. Lines as of "
         "ambience --path. - is standard input. With ambience also the flight before a picture, "
         "which has the view of its end without --camera."},
    {.id = OPTION_FRAMES,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_WHOLE,
     .name = "--frames",
     .value = "N",
     .minimum = 1,
     .maximum = 1000000,
     .initial = "60",
     .help = "Pictures of the flight, at equal times from its first to its last line."},
    {.id = OPTION_REFERENCE,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_TEXT,
     .name = "--reference",
     .value = "IMAGE",
     .help = "Compare the picture with IMAGE: linear with linear (.exr, .hdr), or 8-bit with 8-bit "
             "(.png, .jpg). Prints the root mean square error (rmse), bytes as value / 255. Pixels "
             "count as in compare."},
    {.id = OPTION_REFERENCE_THRESHOLD,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_REAL,
     .name = "--reference-threshold",
     .value = "X",
     .minimum = 0,
     .maximum = 1e9,
     .help = "Exit with 1 if rmse is above X, or if no pixel is covered in both."},
};

const option_part option_part_view = {rows, sizeof rows / sizeof *rows};
