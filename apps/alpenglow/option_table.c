// SPDX-License-Identifier: MIT
// The commands and options themselves: everything that the contract names, built or not.
#include "options.h"

#include <stdlib.h>

static const command_entry commands[COMMAND_COUNT] = {
    [COMMAND_BAKE] =
        {"bake", "SCENE -o OUT.glb|OUT.gltf|OUT.dae [--maps-dir DIR] [OPTIONS]",
         "bake ambient occlusion into a scene", 1, command_bake,
         "Unwraps SCENE into an atlas, computes at every texel how much of the sky above it is "
         "open, and writes a copy of the scene with that occlusion map attached. What the bake "
         "does not touch comes out byte for byte as it was."},
    [COMMAND_RENDER] = {"render", "SCENE -o IMAGE.png|.exr|.hdr --with METHOD [OPTIONS]",
                        "render a picture of a scene", 1, command_render,
                        "Renders SCENE from one of its cameras, or from an automatic one. A .png "
                        "is for looking at, an .exr or .hdr holds the linear values."},
    [COMMAND_INFO] = {"info", "SCENE [--json]", "say what is in a scene", 1, command_info,
                      "Prints what SCENE holds: triangles, surfaces with their texture "
                      "coordinate sets, materials, lights, cameras, size."},
    [COMMAND_COMPARE] =
        {"compare", "A B [--scale S] [--max-rmse X] [--heatmap PNG] [--json FILE]",
         "say how two images differ", 2, command_compare,
         "Compares the images A and B (.exr, .hdr, .png, .jpg) of equal size, over the pixels that "
         "are "
         "covered (alpha above one half, or no alpha) in both. Prints the root mean square error "
         "(rmse), rmse over the mean of B, bias (mean of A - B), the 99th percentile and the "
         "largest of |A - B| and where it is."},
    [COMMAND_BENCH] =
        {"bench", "[ROOM] [--quick] [--scene SCENE] [--markdown]", "measure speed and accuracy", -1,
         command_bench,
         "Measures this machine: in turns, what the hardware and the ray tracer give at most, and "
         "what alpenglow makes of it, as a ratio of medians. ROOM is trace (building), transport "
         "(the innermost loop), atlas, maps (error per second), accuracy (stated against true "
         "errors) or truth (each technique against the reference); without it all are run, which "
         "takes a quarter of an hour. Other work on the machine makes the figures worse and the "
         "ratios little."},
    [COMMAND_PROBES] = {"probes", "SCENE", "bake a grid of light probes", 1, NULL,
                        "bake --maps ao puts light on surfaces"},
    [COMMAND_LPV] = {"lpv", "SCENE", "propagate light through a volume", 1, NULL,
                     "bake --maps ao puts light on surfaces"},
    [COMMAND_AMBIENCE] = {"ambience", "SCENE", "live ambience of a moving scene", 1, NULL,
                          "bake --maps ao puts light on surfaces"},
    [COMMAND_SH] = {"sh", "ENV", "spherical harmonics of a sky", 1, NULL, "nothing instead"},
    [COMMAND_VIEW] = {"view", "SCENE|OUT", "look at a scene", 1, NULL,
                      "render makes a picture, and any glTF viewer shows what bake writes"},
};

#define SCENE_COMMANDS (IN_BAKE | IN_RENDER | IN_INFO)
#define RAY_COMMANDS (IN_BAKE | IN_RENDER)
#define LATER(commands_, name_, value_, instead_)                                                  \
    {                                                                                              \
        .id = OPTION_LATER, .commands = (commands_), .group = GROUP_LATER, .kind = KIND_TEXT,      \
        .name = (name_), .value = (value_), .help = (instead_)                                     \
    }

static const option options[] = {
    // --- output ---------------------------------------------------------------------------------
    {.id = OPTION_OUTPUT,
     .commands = IN_BAKE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "-o",
     .alias = "--output",
     .value = "OUT.glb|OUT.gltf|OUT.dae",
     .help =
         "The baked scene (OUT.json, OUT.babylon: see --lightmap-as). A .gltf gets its buffers "
         "and images beside it, a .dae its images; a .dae is written where SCENE is one. Without "
         "-o, --maps-dir must be given. OUT.obj is not built yet."},
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
     .help = "Print JSON instead of a table."},
    {.id = OPTION_HEATMAP,
     .commands = IN_COMPARE,
     .group = GROUP_OUTPUT,
     .kind = KIND_TEXT,
     .name = "--heatmap",
     .value = "PNG",
     .help = "Write a picture of |A - B|: black 0, white the 99th percentile and above, magenta "
             "covered in one only."},
    {.id = OPTION_FORCE,
     .commands = RAY_COMMANDS | IN_COMPARE,
     .group = GROUP_OUTPUT,
     .kind = KIND_FLAG,
     .name = "-f",
     .alias = "--force",
     .help = "Overwrite existing files. Without it an existing output stops the command before "
             "it starts."},

    // --- what -----------------------------------------------------------------------------------
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
     .help = "Of --with lightmap and radiosity: side of a page of the atlas. Time and memory grow "
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
     .value = "auto|keep|charts|vertex",
     .choices = "auto|keep|charts|vertex",
     .later_choices = "blend",
     .initial = "auto",
     .help = "keep: use the scene's second UV set, which must lie in range and not overlap. "
             "charts: unwrap anew. auto: keep where it is valid, else charts. vertex: no map, but "
             "a value at each vertex, the best for linear interpolation over its triangles; "
             "options of maps, of their error and of stopping have no meaning then and are "
             "refused. Warns where triangles are too large for it."},
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

    // --- picture --------------------------------------------------------------------------------
    {.id = OPTION_QUALITY,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_CHOICE,
     .name = "--quality",
     .value = "preview|medium|high",
     .choices = "preview|medium|high",
     .help = "The same as --error 4, 1 or 0.4."},
    {.id = OPTION_ERROR,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_REAL,
     .name = "--error",
     .value = "PCT",
     .minimum = 0.01,
     .maximum = 100.0,
     .unit = "percent",
     .help = "Bake in rounds of more and more rays until the stated error (root mean square of the "
             "standard errors, over the mean of the map) is at most this, and its 99th percentile "
             "at most four times this. --ao-samples is then the most rays a texel may get, 65536 "
             "when it is not given. Half the error takes about 2.7 times the rays. Light: without "
             "--samples it goes for 1 percent, or for this, whatever its 99th percentile; half the "
             "error takes four times the rays."},
    {.id = OPTION_TIME_LIMIT,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_REAL,
     .name = "--time-limit",
     .value = "S",
     .minimum = 0.001,
     .maximum = 1e9,
     .unit = "seconds",
     .help = "End sampling after this time with what there is. Such a bake is not reproducible, "
             "says so, and states the error it has. Light keeps the rounds that were whole; "
             "with occlusion it has half of the time, and what occlusion leaves. Without --error "
             "it uses all of it. Not with --ao-bleed, nor with light by hemicubes, by paths or "
             "without bounces, which are baked in one go."},
    {.id = OPTION_MEMORY_LIMIT,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_SIZE,
     .name = "--memory-limit",
     .value = "SIZE",
     .minimum = 1048576.0,
     .maximum = 1e15,
     .unit = "bytes; K, M and G stand for 1024, 1024^2 and 1024^3",
     .help =
         "Refuse a bake whose maps need more than this, before its rays are sent. The scene and "
         "the ray tracer's structure are not counted. Without it: nine tenths of the machine's. "
         "Light keeps the rays of its passes in what is left, else it traces them again."},
    {.id = OPTION_ADAPTIVE,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_REAL,
     .name = "--adaptive",
     .value = "A|auto|off",
     .minimum = 0.01,
     .maximum = 0.9999,
     .choices = "auto|off",
     .initial = "auto",
     .help =
         "Which texels are interpolated instead of traced. auto: those between traced ones that "
         "agree within their noise; no error is added that the noise does not hide. A number: "
         "those whose neighbours d texels apart differ by no more than 1 - A^d; 0.5 is a draft, "
         "0.98 careful. off: none. Of light it is bounced light that is interpolated, by auto for "
         "any number."},
    {.id = OPTION_KEEP_PARTIAL,
     .commands = IN_BAKE,
     .group = GROUP_STOP,
     .kind = KIND_FLAG,
     .name = "--keep-partial",
     .help = "Ctrl-C ends sampling and writes what there is, instead of nothing; exit code 130. "
             "Light has nothing before its first round is whole."},

    {.id = OPTION_WITH,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--with",
     .value = "reference|radiosity|lightmap|ao|constant|hemisphere",
     .choices = "ao|constant|hemisphere|reference|lightmap|radiosity",
     .later_choices = "probes|ambience|lpv|cube",
     .help =
         "reference: all light by path tracing. radiosity: direct light at each pixel, and what "
         "surfaces reflect gathered from a radiosity on texels; less noise than reference in "
         "as many --samples. lightmap: bakes --maps light and shows it as a viewer does, emission "
         "+ albedo / pi x irradiance, with its texels; the backs of double-sided surfaces show "
         "their fronts' map. These three see through blended and transmissive surfaces, which "
         "the others cut at an alpha of one half or take for opaque. ao: accessibility, "
         "from the scene's occlusion maps, and by rays where it has none. constant: uniform "
         "light of radiance 1, which shows the albedo: base colour x (1 - metallic), at most "
         "0.95. hemisphere: the two colours of --sky (without it 1,1,1 above and 0,0,0 below), "
         "nothing in their way. Needed."},
    {.id = OPTION_CAMERA,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_TEXT,
     .name = "--camera",
     .value = "N|auto|PX,PY,PZ,TX,TY,TZ,VFOV",
     .initial = "0",
     .help =
         "Camera of the scene, from 0; or position and target in metres and the vertical "
         "field of view in degrees, 0.001 to 179. auto (and a scene without cameras): a view of "
         "everything."},
    {.id = OPTION_RESOLUTION,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_TEXT,
     .name = "--resolution",
     .value = "WxH",
     .initial = "960x540",
     .help = "Size of the picture in pixels, each side 1 to 16384."},
    {.id = OPTION_SAMPLES,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_WHOLE,
     .name = "--samples",
     .value = "N",
     .minimum = 1,
     .maximum = 65536,
     .unit = "camera rays per pixel",
     .initial = "16",
     .help = "More smooth the edges; time grows with N. With reference and radiosity each is a "
             "path, N is rounded up to a multiple of 16, and the noise falls as 1 over the root of "
             "N."},
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
             "it brings anything."},
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
    {.id = OPTION_EXPOSURE,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_REAL,
     .name = "--exposure",
     .value = "EV|auto",
     .choices = "auto",
     .minimum = -64,
     .maximum = 64,
     .unit = "EV",
     .help = "What a .png shows: values times 2^EV; 0 shows 1 as 1, each +1 is twice as bright. "
             "auto: the geometric mean of the brightness of pixels that are not black, without "
             "the darkest and brightest 5 % of them, becomes 18 % grey; the EV used is printed. "
             "Default 0 for ao and constant, else auto."},
    {.id = OPTION_TONE,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--tone",
     .value = "film|reinhard|filmic|none",
     .choices = "film|reinhard|filmic|none",
     .help = "Curve from exposed light L to a .png. film: 1 - e^-L. reinhard: L (1 + L/16) / "
             "(1 + L), white at 4. filmic: Hable's, more contrast, white at 5.6. none: cut off at "
             "1. Default none for ao and constant, else film."},
    {.id = OPTION_WHITE_BALANCE,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_REAL,
     .name = "--white-balance",
     .value = "K|auto|off",
     .choices = "auto|off",
     .minimum = 1000,
     .maximum = 25000,
     .unit = "kelvin",
     .initial = "off",
     .help = "Which light is white in a .png. K: light of this colour temperature; low ones make "
             "the picture bluer. auto: the mean of the picture. off: D65, as it is."},
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

    // --- ambient occlusion ----------------------------------------------------------------------
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

    // --- bench ----------------------------------------------------------------------------------
    {.id = OPTION_QUICK,
     .commands = IN_BENCH,
     .group = GROUP_WHAT,
     .kind = KIND_FLAG,
     .name = "--quick",
     .help =
         "Small sizes and one round, in a second: shows that it runs. The figures mean nothing."},
    {.id = OPTION_BENCH_SCENE,
     .commands = IN_BENCH,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--scene",
     .value = "SCENE",
     .help = "This scene in the place of those that the benches bring, which are built-in ones and "
             "hills:N, a field of hills of N triangles."},
    {.id = OPTION_MARKDOWN,
     .commands = IN_BENCH,
     .group = GROUP_OUTPUT,
     .kind = KIND_FLAG,
     .name = "--markdown",
     .help = "Tables as Markdown, with what they show, as in docs/speed.md."},

    // --- run ------------------------------------------------------------------------------------
    {.id = OPTION_SEED,
     .commands = RAY_COMMANDS,
     .group = GROUP_RUN,
     .kind = KIND_WHOLE,
     .name = "--seed",
     .value = "N",
     .minimum = 0,
     .maximum = 9007199254740992.0,
     .initial = "0",
     .help = "Another seed gives other noise of the same size. The same seed gives the same bits "
             "with any number of threads."},
    {.id = OPTION_THREADS,
     .commands = RAY_COMMANDS,
     .group = GROUP_RUN,
     .kind = KIND_WHOLE,
     .name = "--threads",
     .value = "N|auto",
     .choices = "auto",
     .minimum = 1,
     .maximum = 1024,
     .initial = "auto",
     .help = "auto: one per core. Changes the time and never the result."},
    {.id = OPTION_PROGRESS,
     .commands = RAY_COMMANDS,
     .group = GROUP_RUN,
     .kind = KIND_CHOICE,
     .name = "--progress",
     .value = "auto|plain|json|off",
     .choices = "auto|plain|json|off",
     .initial = "auto",
     .help = "On standard error. auto: one updating line on a terminal, else a line every 5 "
             "seconds. plain: a line at every stage and every 5 seconds. json: one object a line."},
    {.id = OPTION_WARNINGS_AS_ERRORS,
     .commands = RAY_COMMANDS,
     .group = GROUP_RUN,
     .kind = KIND_FLAG,
     .name = "--warnings-as-errors",
     .help = "Stop at the first warning and exit with 1."},
    {.id = OPTION_QUIET,
     .commands = SCENE_COMMANDS | IN_COMPARE,
     .group = GROUP_RUN,
     .kind = KIND_FLAG,
     .name = "-q",
     .alias = "--quiet",
     .help = "No summary, no notes, no progress. Warnings and errors stay, and so does what info "
             "and compare are asked for."},

    {.id = OPTION_HELP,
     .commands = SCENE_COMMANDS | IN_COMPARE | IN_BENCH,
     .group = GROUP_RUN,
     .kind = KIND_FLAG,
     .name = "-h",
     .alias = "--help",
     .help = "Print this."},

    // --- of the contract, not built yet ---------------------------------------------------------
    LATER(IN_BAKE, "--stitch", "on|off", "charts are not stitched"),
    LATER(IN_BAKE, "--checkpoint", "DIR", "a bake runs in one go"),
    LATER(IN_BAKE, "--resume", NULL, "a bake runs in one go"),
    LATER(IN_INFO, "--pictures", "DIR", "render makes a picture"),
};

/// What alpenglow itself takes in the place of a command.
static const option program_options[] = {
    {.id = OPTION_HELP,
     .kind = KIND_FLAG,
     .name = "-h",
     .alias = "--help",
     .help = "Print the commands; after a command, its options."},
    {.id = OPTION_COUNT, .kind = KIND_FLAG, .name = "--version", .help = "Print the version."},
    {.id = OPTION_COUNT,
     .kind = KIND_CHOICE,
     .name = "--completion",
     .value = "bash|zsh|fish",
     .choices = "bash|zsh|fish",
     .help = "Print a script with which that shell completes commands, options and file names."},
};

static const char *const builtin_scenes[] = {
    "builtin:cornell",      "builtin:furnace",     "builtin:bowl",
    "builtin:sphere-plane", "builtin:torus-plane", "builtin:teapot-room",
    "builtin:windows",      "builtin:atrium",      "builtin:terrain",
};

static const char *const group_titles[GROUP_COUNT] = {
    [GROUP_OUTPUT] = "Output",   [GROUP_WHAT] = "What",
    [GROUP_PICTURE] = "Picture", [GROUP_AO] = "Ambient occlusion",
    [GROUP_LIGHT] = "Light",     [GROUP_STOP] = "When to stop",
    [GROUP_RUN] = "Run",         [GROUP_LATER] = "Not built yet (refused by name)",
};

const command_entry *command_table(void)
{
    return commands;
}

const option *option_table(size_t *count)
{
    *count = sizeof options / sizeof *options;
    return options;
}

const option *program_option_table(size_t *count)
{
    *count = sizeof program_options / sizeof *program_options;
    return program_options;
}

const char *const *builtin_scene_names(size_t *count)
{
    *count = sizeof builtin_scenes / sizeof *builtin_scenes;
    return builtin_scenes;
}

const char *builtin_scene_settings(void)
{
    return "  builtin:atrium,triangles=N           20000 to 4000000; default 50000\n"
           "  builtin:terrain,triangles=N,trees=N  5000 to 4000000 (default 60000), 0 to 20000";
}

bool command_interruptible(command_id command)
{
    return command == COMMAND_BAKE || command == COMMAND_RENDER;
}

const option *option_next(command_id command, option_group group, const option *last)
{
    const option *end = options + sizeof options / sizeof *options;
    for (const option *o = last != NULL ? last + 1 : options; o < end; o++) {
        if (o->group == group && (o->commands & (1u << command)) != 0) {
            return o;
        }
    }
    return NULL;
}

int command_operand_limit(command_id command)
{
    return abs(commands[command].operand_count);
}

const char *option_group_title(option_group group)
{
    return group_titles[group];
}
