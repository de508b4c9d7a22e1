// SPDX-License-Identifier: MIT
// The commands and the built-in scenes.
#include "options/options.h"

#include <stdlib.h>

static const command_entry commands[COMMAND_COUNT] = {
    [COMMAND_BAKE] =
        {"bake", "SCENE [[-o] OUT.glb|OUT.gltf|OUT.dae|OUT.obj] [--maps-dir DIR] [OPTIONS]",
         "bake occlusion and light into a scene", 1,
         "Unwraps SCENE into an atlas, bakes maps of occlusion and light (--maps), and writes a "
         "copy "
         "of the scene with these maps attached. All other parts of the scene are copied byte for "
         "byte."},
    [COMMAND_RENDER] = {"render", "SCENE [-o] IMAGE.png|.exr|.hdr --with METHOD [OPTIONS]",
                        "render a picture of a scene", 1,
                        "Renders SCENE from one of its cameras, or from an automatic one. A .png "
                        "is for display; an .exr or .hdr holds linear values."},
    [COMMAND_INFO] = {"info", "SCENE [--json] [--pictures DIR]",
                      "list the contents and faults of a scene", 1,
                      "Prints the contents of SCENE: triangles, surfaces, materials, lights, "
                      "cameras, size. States which texture coordinate sets can hold a bake. Lists "
                      "faults with their visible effect and their remedy: errors (the scene cannot "
                      "be baked) first, then warnings (the result will have a visible fault), then "
                      "notes. Findings do not change the exit status."},
    [COMMAND_COMPARE] =
        {"compare", "A B [--scale S] [--max-rmse X] [--heatmap PNG] [--json FILE]",
         "measure the difference of two images or two bakes", 2,
         "Compares two images A and B (.exr, .hdr, .png, .jpg) of equal size, over the pixels that "
         "are covered (alpha above 0.5, or no alpha) in both. Prints the root mean square error "
         "(rmse), rmse over the mean of B, the bias (mean of A - B), and the 99th percentile and "
         "maximum of |A - B| with its position. Or compares a map of two scenes of the same "
         "triangles (.glb, .gltf, .dae, .zae, .obj) over their surface. Each map is read by its "
         "own coordinates, as in a viewer; those of --atlas blend are blended."},
    [COMMAND_SAMPLE] =
        {"sample", "SCENE --with MODEL --at POINTS.csv [OPTIONS]",
         "print the irradiance at points of space", 1,
         "Prints the irradiance of a model of light at points, as CSV on standard output: the "
         "columns of POINTS, then r,g,b [W/m2] and error, the expected RMS error of one channel "
         "[W/m2]. Every model holds the same light: sky, emissive surfaces and reflected light "
         "(--direct)."},
    [COMMAND_PROBES] =
        {"probes", "SCENE [-o] OUT.probes.json [OPTIONS]", "bake light probes", 1,
         "Solves the light of SCENE and samples it at probes, for everything that moves. Probes "
         "stand on a grid (--spacing, --bounds) or at any places (--at). docs/manual/"
         "probe-format.md describes the files."},
    [COMMAND_AMBIENCE] =
        {"ambience", "SCENE --path FLIGHT.csv [OPTIONS]", "fly a camera with live light", 1,
         "Flies a camera through SCENE and lights what is around it: a volume of light probes "
         "that are sampled frame by frame, fade in, and expire. Prints anchors, samples, memory, "
         "time and error of each second. docs/manual/ambience.md explains them."},
    [COMMAND_LPV] =
        {"lpv", "SCENE [OPTIONS]", "propagate light through a grid, frame by frame", 1,
         "Lights SCENE anew in each of some frames, under a sun that turns: traces maps of the "
         "surfaces that lamps light, injects their light into a grid of cells, and lets it travel "
         "from cell to cell. Prints the time of each stage. docs/manual/lpv.md explains them."},
    [COMMAND_SH] = {"sh", "ENV [--convention NAME] [[-o] IMAGE.hdr|.exr|.png]",
                    "print the spherical harmonics of an environment", 1,
                    "Projects ENV to nine coefficients and prints them, one \"r g b\" a line, for "
                    "the program that --convention names. ENV is an equirectangular image of "
                    "radiance (.hdr, .exr), as for --sky of other commands: its first row is up "
                    "(+Y), its middle column -Z, columns to the right turn towards +X. -o writes "
                    "the irradiance of every direction as an image of the same layout."},
    [COMMAND_BENCH] =
        {"bench", "[ROOM] [--quick] [--scene SCENE] [--markdown]", "measure speed and accuracy", -1,
         "Measures this machine: the limit of the hardware or the ray tracer, and alpenglow, in "
         "turns. Prints the ratio of their medians. Other load on the machine changes the figures "
         "much and the ratios little. Without ROOM all benches run, which takes more than half an "
         "hour. ROOM is trace (building), transport (the innermost loop), atlas, maps (error per "
         "second), accuracy (stated against true errors), truth (each technique against the "
         "reference), denoise, bounced (methods of gathering bounced light), light (its rays "
         "against the ray tracer, its bakes by workers and size), sh (projection of cube maps), "
         "probes (look-ups, and rays against the ray tracer), fields (models of light in space "
         "against the reference), ambience (the live volume along flights) or formats (reading)."},
    [COMMAND_VIEW] =
        {"view", "SCENE [-o] IMAGE.png|.exr|.hdr --with MODE [OPTIONS]",
         "draw a scene on the graphics card", 1,
         "Draws SCENE by OpenGL 4.5, without a window: one picture (-o), or the pictures of a "
         "flight (--frames, --path, --pictures). A picture has the camera, the exposure and the "
         "tone curve of render. This is a program of its own, alpenglow-view, which needs EGL; "
         "without a graphics card, Mesa draws on the processor."},
    [COMMAND_STATUS] = {"status", "DIR [--json [FILE]]",
                        "print the progress of a checkpointed bake", 1,
                        "Prints the state that the processes of a bake keep in the DIR of "
                        "--checkpoint: what is done, the stated error so far, the time left at the "
                        "last write, and shards that are missing."},
    [COMMAND_MERGE] = {"merge", "DIR [-o OUT]", "write the result of a bake's shards", 1,
                       "Reads the shards that 'bake --shard I/N --checkpoint DIR' left in DIR, and "
                       "writes what one bake with --adaptive off would have written, with the same "
                       "bits. OUT is its asset, or its folder of maps; without OUT, the names of "
                       "the bake. Missing shards are listed for sbatch --array."},
    [COMMAND_WEB] = {"web", "BAKED [-o] OUT.html [--maps-dir DIR] [--probes FILE] [--volume FILE]",
                     "write a baked scene as a page for browsers", 1,
                     "Writes one HTML file that shows BAKED, a .glb or .gltf, by three.js: the "
                     "camera orbits, occlusion and light can be switched, and the exposure be "
                     "set. The file opens from the disk, without a server or a network. "
                     "docs/manual/web.md explains it."},
};

static const char *const builtin_scenes[] = {
    "builtin:cornell",      "builtin:furnace",     "builtin:bowl",
    "builtin:sphere-plane", "builtin:torus-plane", "builtin:teapot-room",
    "builtin:windows",      "builtin:atrium",      "builtin:terrain",
};

const command_entry *command_table(void)
{
    return commands;
}

int command_operand_limit(command_id command)
{
    return abs(commands[command].operand_count);
}

bool command_interruptible(command_id command)
{
    return command == COMMAND_BAKE || command == COMMAND_RENDER || command == COMMAND_SAMPLE ||
           command == COMMAND_PROBES || command == COMMAND_AMBIENCE || command == COMMAND_LPV ||
           command == COMMAND_VIEW || command == COMMAND_MERGE;
}

bool command_has_scene(command_id command)
{
    return command != COMMAND_COMPARE && command != COMMAND_SH && command != COMMAND_STATUS &&
           command != COMMAND_MERGE && command != COMMAND_WEB;
}

bool command_is_picture(command_id command)
{
    return command == COMMAND_RENDER || command == COMMAND_VIEW;
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
