// SPDX-License-Identifier: MIT
// Rows of the table of options: light, its sources, gathering and storage.
#include "options/option_parts.h"

static const option rows[] = {
    {.id = OPTION_TEXEL_SAMPLES,
     .commands = IN_RENDER | IN_VIEW,
     .group = GROUP_LIGHT,
     .kind = KIND_WHOLE,
     .name = "--texel-samples",
     .value = "N",
     .minimum = 1,
     .maximum = 65536,
     .unit = "rays per texel",
     .initial = "256",
     .help = "Rays per texel, for --with lightmap, as --samples in bake."},
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
     .help = "Rays per texel of --maps light, rounded up to a multiple of 32. With "
             "--gather paths: paths per texel, to a multiple of 16. With --bounces 0: "
             "samples of each light, to a multiple of 8. Occlusion has --ao-samples."},
    {.id = OPTION_GATHER,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--gather",
     .value = "rays|hemicube|paths",
     .choices = "rays|hemicube|paths",
     .initial = "rays",
     .help = "Method of gathering bounced light.\n"
             "rays: radiosity by cosine-distributed rays.\n"
             "hemicube: radiosity by the five faces of half a cube around each texel, "
             "without an estimate of the error.\n"
             "paths: the reference path tracer, unbiased and many times slower."},
    {.id = OPTION_GATHER,
     .commands = IN_RENDER,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--gather",
     .value = "rays|hemicube|paths",
     .choices = "rays|hemicube|paths",
     .initial = "rays",
     .help = "Method of gathering bounced light for the map that --with lightmap bakes, as in "
             "bake."},
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
     .help = "Edge of the front face of --gather hemicube, an even number. A texel "
             "takes 3 N N rays."},
    {.id = OPTION_EMITTERS,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--emitters",
     .value = "analytic|counted",
     .choices = "analytic|counted",
     .initial = "analytic",
     .help = "Light straight from emissive surfaces, with --gather hemicube.\n"
             "analytic: closed forms, and rays aimed at them.\n"
             "counted: the pixels that see them. Pixels on the edge of an emitter "
             "cause an error: 4 % of the mean in builtin:cornell at 64 pixels. "
             "Emitters between pixels are lost. Lamps, suns and skies are sampled as "
             "before. Takes twice the rays."},
    {.id = OPTION_DENOISE,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--denoise",
     .value = "on|off",
     .choices = "off|on",
     .initial = "off",
     .help = "Filter for the noise of bounced light.\n"
             "on: averages neighbours in space, across charts but never across a wall. "
             "Direct light is not filtered. Every texel is gathered, and few --samples "
             "suffice. Means change by some tenths of a percent."},
    {.id = OPTION_DIRECT,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--direct",
     .value = "on|off|only|apart",
     .choices = "on|off|only|apart",
     .initial = "on",
     .help = "Light straight from its sources.\n"
             "on: in the map.\n"
             "off: not in the map, for a renderer that adds its own.\n"
             "only: nothing else in the map; the same as --bounces 0.\n"
             "apart: in the map, and also in irradiance.direct.exr, with the rest in "
             "irradiance.bounced.exr."},
    {.id = OPTION_LAYERS,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_FLAG,
     .name = "--layers",
     .help = "Also write a map of each light alone, with its reflections. --maps-dir "
             "gets irradiance.NAME.exr for each lamp, sun, emissive material and the "
             "sky. They sum to irradiance.exr exactly. Beyond 16 the last is \"others\"."},
    {.id = OPTION_LIGHTMAP_AS,
     .commands = IN_BAKE,
     .common = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--lightmap-as",
     .value = "emissive|moz|extras|three|babylon",
     .example = "emissive",
     .choices = "emissive|moz|extras|three|babylon",
     .help = "Form of the light in -o, with its own coordinate set. Default emissive; three "
             "and babylon by the name of -o. It includes the light of the file's lamps. Switch "
             "those off in "
             "the viewer, or bake --direct off (not with emissive).\n"
             "emissive: the light that leaves each surface, as emission in 8-bit sRGB "
             "(KHR_materials_emissive_strength) with base colour 0. Textures are no "
             "finer than the map. Opens in every glTF viewer.\n"
             "moz: MOZ_lightmap, 8-bit linear, 255 steps to the brightest texel of "
             "each material. Opens in Hubs, and in three.js after r187 with the addon "
             "loader.register(p => new GLTFLightMapLoaderExtension(p)). Other viewers "
             "ignore it.\n"
             "extras: half floats in a file beside -o, named by the extras of each "
             "material. No viewer opens it by itself. In three.js: m.lightMap = await "
             "new KTX2Loader().detectSupport(renderer).loadAsync(uri), "
             "m.lightMap.channel = texCoord, m.lightMapIntensity = intensity.\n"
             "three: -o OUT.json, the scene as three.js Object JSON with half floats. "
             "Opens with new ObjectLoader().loadAsync(url). The file's lamps are left "
             "out.\n"
             "babylon: -o OUT.babylon with OUT.hdr beside it. Opens in Babylon.js with "
             "AppendSceneAsync(url, scene). The file's lamps are left out."},
    {.id = OPTION_UNITS,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--units",
     .value = "irradiance|irradiance/pi|radiance",
     .choices = "irradiance|irradiance/pi|radiance",
     .help = "Units of --lightmap-as; irradiance.exr in --maps-dir is always "
             "irradiance. Default irradiance; emissive is always radiance, moz never.\n"
             "irradiance: E, for three.js.\n"
             "irradiance/pi: E / pi, for PlayCanvas, Godot, Unity and Blender.\n"
             "radiance: albedo x E / pi + emission, the light that leaves the surface, "
             "for Babylon.js."},
    {.id = OPTION_LIGHTMAP_FORMAT,
     .commands = IN_BAKE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--lightmap-format",
     .value = "ktx2|exr|hdr",
     .choices = "ktx2|exr|hdr",
     .initial = "ktx2",
     .help = "File format of --lightmap-as extras.\n"
             "ktx2: RGBA half floats, Zstandard, A is coverage. Upright in three.js.\n"
             "exr: RGB half floats, ZIP. Set flipY in three.js; gammaSpace = false and "
             "vScale = -1 in Babylon.js.\n"
             "hdr: Radiance RGBE, 8 bits and an exponent."},
    {.id = OPTION_BOUNCES,
     .commands = LIGHT_COMMANDS & ~(IN_AMBIENCE | IN_LPV),
     .group = GROUP_LIGHT,
     .kind = KIND_WHOLE,
     .name = "--bounces",
     .value = "N|converge",
     .example = "3",
     .minimum = 0,
     .maximum = 1000,
     .choices = "converge",
     .initial = "converge",
     .help = "Number of reflections of light.\n"
             "0: direct light alone.\n"
             "converge: until further bounces add nothing. With --error, passes end "
             "when further ones would add less than a hundredth of it."},
    {.id = OPTION_METALS,
     .commands = LIGHT_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--metals",
     .value = "diffuse|black",
     .choices = "diffuse|black",
     .initial = "diffuse",
     .help = "Albedo of metals, for light and --ao-bleed.\n"
             "diffuse: base colour, as of other materials; about what a metal "
             "reflects.\n"
             "black: base colour x (1 - metallic). Viewers that multiply a light map by "
             "their diffuse colour show metals black either way."},
    {.id = OPTION_SKY,
     .commands = SKY_COMMANDS,
     .common = IN_BAKE | IN_RENDER,
     .group = GROUP_LIGHT,
     .kind = KIND_TEXT,
     .name = "--sky",
     .value = "FILE|L|R,G,B|R,G,B/R,G,B|clear",
     .example = "1,1,1",
     .help = "Light from outside. Default: black.\n"
             "FILE: an equirectangular .hdr or .exr.\n"
             "R,G,B: radiance from every direction, W/(sr m2), linear. L: the same in all "
             "three.\n"
             "R,G,B/R,G,B: radiance above and below the horizon.\n"
             "clear: a clear sky around the --sun, which it needs."},
    {.id = OPTION_SKY_TURN,
     .commands = SKY_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_REAL,
     .name = "--sky-turn",
     .value = "DEG",
     .minimum = -360,
     .maximum = 360,
     .unit = "degrees",
     .initial = "0",
     .help = "Turn of the sky image, counter-clockwise from above."},
    {.id = OPTION_SKY_STRENGTH,
     .commands = SKY_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_REAL,
     .name = "--sky-strength",
     .value = "S",
     .minimum = 0,
     .maximum = 1e6,
     .initial = "1",
     .help = "Factor on the sky's radiance."},
    {.id = OPTION_SUN,
     .commands = LIGHT_COMMANDS,
     .common = IN_BAKE | IN_RENDER,
     .group = GROUP_LIGHT,
     .kind = KIND_TEXT,
     .name = "--sun",
     .value = "AZ,EL,LUX",
     .example = "150,40,60000",
     .help = "A sun beside the lights of the scene. AZ: azimuth in degrees from +Z "
             "towards +X. EL: elevation in degrees. LUX: illuminance of a surface that "
             "faces it."},
    {.id = OPTION_SUN_SIZE,
     .commands = LIGHT_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_REAL,
     .name = "--sun-size",
     .value = "DEG",
     .minimum = 0,
     .maximum = 90,
     .unit = "degrees",
     .help = "Full angle of the disk of every sun, which softens shadows. Default 0.53 "
             "for --sun, and 0 for directional lights of the scene."},
    {.id = OPTION_LAMP,
     .commands = LIGHT_COMMANDS,
     .common = IN_BAKE | IN_RENDER,
     .group = GROUP_LIGHT,
     .kind = KIND_TEXT,
     .repeats = true,
     .name = "--lamp",
     .value = "X,Y,Z,CANDELA[,R,G,B]",
     .example = "0,2,0,100",
     .help = "A point light beside the lights of the scene: position in metres, "
             "intensity, linear colour (default 1,1,1). May be repeated: up to 64 "
             "--lamp and --spot together."},
    {.id = OPTION_SPOT,
     .commands = LIGHT_COMMANDS,
     .group = GROUP_LIGHT,
     .kind = KIND_TEXT,
     .repeats = true,
     .name = "--spot",
     .value = "X,Y,Z,TX,TY,TZ,CANDELA,INNER,OUTER[,R,G,B]",
     .help = "A spot light at X,Y,Z, aimed at TX,TY,TZ. Full intensity up to INNER "
             "degrees from its axis, none from OUTER on, as in KHR_lights_punctual; 0 "
             "to 90, INNER below OUTER. Otherwise like --lamp."},
};

const option_part option_part_light = {rows, sizeof rows / sizeof *rows};
