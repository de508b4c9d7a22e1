// SPDX-License-Identifier: MIT
// Rows of the table of options: pictures.
#include "options/option_parts.h"

static const option rows[] = {
    {.id = OPTION_WITH,
     .commands = IN_RENDER,
     .common = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--with",
     .value = "METHOD",
     .choices = "ao|albedo|reference|lightmap|radiosity|hemicube|constant|hemisphere|ground-map|"
                "ambient-cube|environment|probes|ambience|lpv",
     .help = "Method of rendering, required: reference, lightmap, radiosity, ao, albedo or another "
             "one.\n"
             "reference, radiosity, lightmap and the models of ambient light see through blended "
             "and transmissive surfaces; the others cut them at alpha 0.5 or take them as opaque.\n"
             "reference: all light by path tracing.\n"
             "radiosity: direct light at each pixel, bounced light from a radiosity on "
             "texels. Less noise than reference at equal --samples.\n"
             "lightmap: displays a light map like a viewer, emission + albedo / pi x "
             "irradiance: the one that SCENE holds, before --sky and --sun, or a new one, which "
             "--size, --quality, --lamp and other options of baking ask for. Backs of double-sided "
             "surfaces use the map of their fronts.\n"
             "ao: accessibility from the scene's occlusion maps; by rays for surfaces "
             "without one.\n"
             "albedo: uniform light of radiance 1, so the albedo, at most 0.95 "
             "(--metals).\n"
             "hemicube: the five faces of half a cube at the camera, as a texel there "
             "sees them if it faces the target (--show, --hemicube).\n"
             "probes: light probes, from --probes FILE or baked with --spacing.\n"
             "ambience: the live volume after a flight (--path, --time), from its camera unless "
             "--camera is given.\n"
             "lpv: light propagated through a grid of cells, without precomputation (--grid).\n"
             "constant, hemisphere, ground-map, ambient-cube, environment: classic models of "
             "ambient light, fitted to the scene's light (see sample). Light straight from "
             "lamps and suns is added at each pixel, with shadows (--direct)."},
    {.id = OPTION_CAMERA,
     .commands = IN_RENDER | IN_VIEW | IN_LPV,
     .common = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_TEXT,
     .name = "--camera",
     .value = "N|auto|PX,PY,PZ,TX,TY,TZ,VFOV",
     .initial = "0",
     .help = "Camera of the picture: one of the scene, auto, or a place with a target.\n"
             "N: camera of the scene, from 0.\n"
             "PX,...: position and target in metres, and the vertical field of view in "
             "degrees, 0.001 to 179.\n"
             "auto: a view of everything; also the default for a scene without "
             "cameras."},
    {.id = OPTION_RESOLUTION,
     .commands = IN_RENDER | IN_VIEW,
     .common = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_TEXT,
     .name = "--resolution",
     .value = "WxH",
     .initial = "960x540",
     .help = "Size of the picture in pixels, each side 1 to 16384."},
    {.id = OPTION_SAMPLES,
     .commands = IN_RENDER,
     .common = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_WHOLE,
     .name = "--samples",
     .value = "N",
     .minimum = 1,
     .maximum = 65536,
     .unit = "camera rays per pixel",
     .initial = "16",
     .help = "Rays per pixel; more give smoother edges. Time grows with N. One goes through the "
             "middle of the pixel. For "
             "reference and radiosity they are paths, rounded up to a multiple of 16, "
             "with noise of 1 / sqrt(N)."},
    {.id = OPTION_DIRECT,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--direct",
     .value = "on|off",
     .choices = "off|on",
     .initial = "on",
     .help = "Light straight from lamps and suns on the surfaces in view, for reference, "
             "radiosity, probes, ambience and the models of ambient light."},
    {.id = OPTION_LOOKUP,
     .commands = IN_RENDER | IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--lookup",
     .value = "ours|three",
     .choices = "ours|three",
     .later_choices = "bevy|godot",
     .initial = "ours",
     .help = "Reader of --with probes.\n"
             "ours: weights by visibility, so that light stays in its room.\n"
             "three: LightProbeGrid of three.js, trilinear, half a cell along the normal."},
    {.id = OPTION_OBJECT,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_TEXT,
     .name = "--object",
     .value = "sphere|teapot,X,Y,Z,RADIUS",
     .help =
         "A white object at X,Y,Z, lit by the method: reference, probes, ambience or a model of "
         "ambient light. It casts no shadow."},
    {.id = OPTION_OBJECT,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_TEXT,
     .name = "--object",
     .value = "sphere|teapot,X,Y,Z,RADIUS",
     .help =
         "A white object at X,Y,Z, lit by the mode: direct, probes, ambience, lpv or a model of "
         "ambient light. It casts shadows of lamps and suns, and is in the maps that light the "
         "volume of lpv (--read pixel). Other light is as without it."},
    {.id = OPTION_OBJECT_PATH,
     .commands = IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_TEXT,
     .name = "--object-path",
     .value = "FLIGHT.csv",
     .help = "Lines of t,px,py,pz that move the centre of --object in the pictures of a flight: "
             "seconds of the flight and metres, straight from line to line. - is standard input."},
    {.id = OPTION_OVERLAY,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--overlay",
     .value = "probes",
     .choices = "probes",
     .later_choices = "cells",
     .help = "probes: small spheres that show the light of each probe, with --with probes or "
             "--probes. Orange: filled, in a solid. Magenta: black, in a solid."},
    {.id = OPTION_SHOW,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--show",
     .value = "seen|product|weight|perspective|lambert",
     .choices = "seen|product|weight|perspective|lambert",
     .initial = "seen",
     .help = "Picture of --with hemicube.\n"
             "seen: radiance of surfaces and sky, from a radiosity on texels. Lamps "
             "are not visible.\n"
             "product: seen x weight. 4 / (N N) times the sum of its pixels is the "
             "irradiance.\n"
             "weight: weight of each pixel, 1 straight ahead.\n"
             "perspective, lambert: the two cosines in weight."},
    {.id = OPTION_HEMICUBE,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_WHOLE,
     .name = "--hemicube",
     .value = "N",
     .minimum = 2,
     .maximum = 1024,
     .unit = "pixels",
     .initial = "256",
     .help = "Edge of the front face of --with hemicube, an even number. The picture "
             "is the unfolded cross of 2 N x 2 N, instead of --resolution."},
    {.id = OPTION_EXPOSURE,
     .commands = IN_RENDER | IN_VIEW,
     .common = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_REAL,
     .name = "--exposure",
     .value = "EV|auto",
     .choices = "auto",
     .minimum = -64,
     .maximum = 64,
     .unit = "EV",
     .help = "Exposure of a .png: values times 2^EV. Default 0 for ao, albedo and "
             "the weights of --show, else auto.\n"
             "auto: the geometric mean of the luminance becomes 18 % grey, without "
             "black pixels and the darkest and brightest 5 %. The EV is printed."},
    {.id = OPTION_TONE,
     .commands = IN_RENDER | IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--tone",
     .value = "film|reinhard|filmic|none",
     .choices = "film|reinhard|filmic|none",
     .help = "Curve from exposed light L to a .png. Default none for ao, albedo and "
             "the weights of --show, else film.\n"
             "film: 1 - e^-L\n"
             "reinhard: L (1 + L/16) / (1 + L), white at 4\n"
             "filmic: Hable's curve, more contrast, white at 5.6\n"
             "none: clipped at 1"},
    {.id = OPTION_WHITE_BALANCE,
     .commands = IN_RENDER | IN_VIEW,
     .group = GROUP_PICTURE,
     .kind = KIND_REAL,
     .name = "--white-balance",
     .value = "K|auto|off",
     .choices = "auto|off",
     .minimum = 1000,
     .maximum = 25000,
     .unit = "kelvin",
     .initial = "off",
     .help = "Light that becomes white in a .png.\n"
             "K: light of this colour temperature. Low ones make the picture bluer.\n"
             "auto: the mean of the picture.\n"
             "off: D65, no change."},
};

const option_part option_part_picture = {rows, sizeof rows / sizeof *rows};
