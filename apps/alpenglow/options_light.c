// SPDX-License-Identifier: MIT
// Rows of the table of options: light, where it comes from and how it is found and stored.
#include "option_parts.h"

static const option rows[] = {
    {.id = OPTION_TEXEL_SAMPLES,
     .commands = IN_RENDER,
     .group = GROUP_LIGHT,
     .kind = KIND_WHOLE,
     .name = "--texel-samples",
     .value = "N",
     .minimum = 1,
     .maximum = 65536,
     .unit = "rays per texel",
     .initial = "256",
     .help = "Of --with lightmap, as --samples of bake; no error is gone for."},
    {.id = OPTION_SAMPLES,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_WHOLE,
     .name = "--samples",
     .value = "N",
     .minimum = 1,
     .maximum = 65536,
     .unit = "rays per texel",
     .initial = "256",
     .help =
         "Of --maps light: rays of a texel, rounded up to a multiple of 32; with --gather paths "
         "its paths, to a multiple of 16; with --bounces 0 samples of each light, to a "
         "multiple of 8. --ao-samples are those of ao."},
    {.id = OPTION_GATHER,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--gather",
     .value = "rays|hemicube|paths",
     .choices = "rays|hemicube|paths",
     .initial = "rays",
     .help = "How --maps light finds what surfaces reflect. rays: radiosity, each texel by rays in "
             "cosine-distributed directions. hemicube: radiosity, each texel by the five faces of "
             "a half cube about it, without an estimate of the error. paths: the reference path "
             "tracer, without bias and many times slower."},
    {.id = OPTION_HEMICUBE,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_WHOLE,
     .name = "--hemicube",
     .value = "N",
     .minimum = 2,
     .maximum = 1024,
     .unit = "pixels",
     .initial = "64",
     .help = "Edge of the front face of --gather hemicube, an even number: 3 N N rays a texel."},
    {.id = OPTION_EMITTERS,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--emitters",
     .value = "analytic|counted",
     .choices = "analytic|counted",
     .initial = "analytic",
     .help = "Of --gather hemicube: light that comes straight from emissive surfaces. analytic: by "
             "closed forms and rays aimed at them. counted: by the pixels that see them, which err "
             "by those that the edges of a light cross, and lose what falls between them: 4 % of "
             "the mean in builtin:cornell at 64 pixels, against analytic. Lamps, suns and skies "
             "stay as they are; twice the rays."},
    {.id = OPTION_DENOISE,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--denoise",
     .value = "on|off",
     .choices = "off|on",
     .initial = "off",
     .help =
         "on: the noise of bounced light is taken off by neighbours in space, across charts and "
         "never across a wall; direct light stays as it is. Then every texel gathers, and few "
         "--samples do; means move by some tenths of a percent."},
    {.id = OPTION_DIRECT,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--direct",
     .value = "on|off|only|apart",
     .choices = "on|off|only|apart",
     .initial = "on",
     .help =
         "Light that comes straight from where it is made. on: in the map. off: not in the map, "
         "for a renderer that adds its own. only: nothing else, the same as --bounces 0. "
         "apart: in the map, and in irradiance.direct.exr, beside the rest in "
         "irradiance.bounced.exr."},
    {.id = OPTION_LAYERS,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_FLAG,
     .name = "--layers",
     .help = "Besides, a map of what each light gives alone, its reflections included: "
             "irradiance.NAME.exr in --maps-dir for each lamp, sun, emissive material and the sky, "
             "by their names. They add up to irradiance.exr exactly. Of more than 16 the last is "
             "\"others\"."},
    {.id = OPTION_LIGHTMAP_AS,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--lightmap-as",
     .value = "emissive|moz|extras|three|babylon",
     .choices = "emissive|moz|extras|three|babylon",
     .help =
         "How light goes into -o, read with a coordinate set of its own; needs --maps light. The "
         "light of the file's lamps is in it: switch them off where it is shown, or bake --direct "
         "off, "
         "which emissive cannot. emissive: what "
         "leaves each surface, as emission in 8-bit sRGB (KHR_materials_emissive_strength), base "
         "colour 0, textures no finer than the map; opens in every glTF viewer, nothing to hook "
         "up. moz: MOZ_lightmap, 8-bit linear in 255 steps to the brightest of each material; "
         "opens in Hubs, and in three.js with loader.register(p => new "
         "GLTFLightMapLoaderExtension(p)), an addon after r187; others ignore it. extras: half "
         "floats in "
         "a file beside -o, which the extras of each material name; opens nowhere by itself; in "
         "three.js: m.lightMap = await new KTX2Loader().detectSupport(renderer).loadAsync(uri), "
         "m.lightMap.channel = texCoord, m.lightMapIntensity = intensity. three: -o OUT.json, the "
         "scene as three.js Object JSON with half floats; opens in three.js with new "
         "ObjectLoader().loadAsync(url), nothing to hook up. babylon: -o OUT.babylon with OUT.hdr "
         "beside it; opens in Babylon.js with AppendSceneAsync(url, scene). Both have no lamps "
         "beside the light."},
    {.id = OPTION_UNITS,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--units",
     .value = "irradiance|irradiance/pi|radiance",
     .choices = "irradiance|irradiance/pi|radiance",
     .help =
         "What --lightmap-as stores; irradiance.exr in --maps-dir is always irradiance. "
         "irradiance: E, for three.js (default). irradiance/pi: E / pi, for PlayCanvas, Godot, "
         "Unity and Blender. radiance: albedo x E / pi + emission, what leaves the surface, for "
         "Babylon.js; emissive is always that, moz never."},
    {.id = OPTION_LIGHTMAP_FORMAT,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--lightmap-format",
     .value = "ktx2|exr|hdr",
     .choices = "ktx2|exr|hdr",
     .initial = "ktx2",
     .help = "Of --lightmap-as extras. ktx2: RGBA half floats, Zstandard, A is coverage; the right "
             "way up in three.js. exr: RGB half floats, ZIP; set flipY in three.js, gammaSpace = "
             "false and vScale = -1 in Babylon.js. hdr: Radiance RGBE, 8 bits and an exponent."},
    {.id = OPTION_BOUNCES,
     .commands = RAY_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_WHOLE,
     .name = "--bounces",
     .value = "N|converge",
     .minimum = 0,
     .maximum = 1000,
     .choices = "converge",
     .initial = "converge",
     .help = "How often light is reflected on its way. 0: direct light alone. converge: as long as "
             "it brings anything. For an --error passes of light end sooner where those left would "
             "bring less than a hundredth of it."},
    {.id = OPTION_SKY,
     .commands = RAY_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_TEXT,
     .name = "--sky",
     .value = "FILE|R,G,B|R,G,B/R,G,B|clear",
     .help = "Light from outside: an equirectangular .hdr or .exr, a radiance from everywhere, one "
             "above and one below the horizon (W/(sr m2), linear), or a clear sky about the --sun, "
             "which it needs. Without it the sky is black."},
    {.id = OPTION_SKY_TURN,
     .commands = RAY_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_REAL,
     .name = "--sky-turn",
     .value = "DEG",
     .minimum = -360,
     .maximum = 360,
     .unit = "degrees",
     .initial = "0",
     .help = "Turn the picture of the sky counter-clockwise, seen from above."},
    {.id = OPTION_SKY_STRENGTH,
     .commands = RAY_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_REAL,
     .name = "--sky-strength",
     .value = "S",
     .minimum = 0,
     .maximum = 1e6,
     .initial = "1",
     .help = "Factor on the sky's radiance."},
    {.id = OPTION_SUN,
     .commands = RAY_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_TEXT,
     .name = "--sun",
     .value = "AZ,EL,LUX",
     .help = "A sun beside the lights of the scene: azimuth in degrees from +Z towards +X, "
             "elevation in degrees, and the illuminance of a surface that faces it."},
    {.id = OPTION_SUN_SIZE,
     .commands = RAY_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_REAL,
     .name = "--sun-size",
     .value = "DEG",
     .minimum = 0,
     .maximum = 90,
     .unit = "degrees",
     .help = "Full angle of the disk of every sun, which makes shadows soft. Without it 0.53 for "
             "--sun and 0 for the directional lights of the scene."},
    {.id = OPTION_LAMP,
     .commands = RAY_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_TEXT,
     .repeats = true,
     .name = "--lamp",
     .value = "X,Y,Z,CANDELA[,R,G,B]",
     .help = "A point light beside the lights of the scene: its place in metres, its intensity and "
             "its colour (linear; 1,1,1 without it). May be given again: 64 of --lamp and --spot "
             "together."},
    {.id = OPTION_SPOT,
     .commands = RAY_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_TEXT,
     .repeats = true,
     .name = "--spot",
     .value = "X,Y,Z,TX,TY,TZ,CANDELA,INNER,OUTER[,R,G,B]",
     .help = "A spot light at X,Y,Z that shines at TX,TY,TZ: full intensity up to INNER degrees "
             "from that axis, none from OUTER on, 0 to 90 and INNER below OUTER, as "
             "KHR_lights_punctual has it. Otherwise like --lamp."},
};

const option_part option_part_light = {rows, sizeof rows / sizeof *rows};
