// SPDX-License-Identifier: MIT
// The commands and the built-in scenes: everything that the contract names, built or not.
#include "options.h"

#include <stdlib.h>

static const command_entry commands[COMMAND_COUNT] = {
    [COMMAND_BAKE] =
        {"bake", "SCENE -o OUT.glb|OUT.gltf|OUT.dae|OUT.obj [--maps-dir DIR] [OPTIONS]",
         "bake ambient occlusion into a scene", 1, command_bake,
         "Unwraps SCENE into an atlas, computes at every texel how much of the sky above it is "
         "open, and writes a copy of the scene with that occlusion map attached. What the bake "
         "does not touch comes out byte for byte as it was."},
    [COMMAND_RENDER] = {"render", "SCENE -o IMAGE.png|.exr|.hdr --with METHOD [OPTIONS]",
                        "render a picture of a scene", 1, command_render,
                        "Renders SCENE from one of its cameras, or from an automatic one. A .png "
                        "is for looking at, an .exr or .hdr holds the linear values."},
    [COMMAND_INFO] = {"info", "SCENE [--json] [--pictures DIR]",
                      "say what is in a scene, and what is wrong with it", 1, command_info,
                      "Prints what SCENE holds: triangles, surfaces, materials, lights, cameras, "
                      "size; which texture coordinate sets can hold a bake; and what is wrong, "
                      "errors (it cannot be baked) first, then warnings (something will look "
                      "wrong), then notes: each with what will be seen and what to do. Findings "
                      "do not change the exit status."},
    [COMMAND_COMPARE] =
        {"compare", "A B [--scale S] [--max-rmse X] [--heatmap PNG] [--json FILE]",
         "say how two images or two bakes differ", 2, command_compare,
         "Compares the images A and B (.exr, .hdr, .png, .jpg) of equal size, over the pixels that "
         "are "
         "covered (alpha above one half, or no alpha) in both. Prints the root mean square error "
         "(rmse), rmse over the mean of B, bias (mean of A - B), the 99th percentile and the "
         "largest of |A - B| and where it is. Or compares a map of two scenes of the same "
         "triangles (.glb, .gltf, .dae, .obj) over their surface, each read by its own "
         "coordinates as a viewer reads it, those of --atlas blend blended."},
    [COMMAND_BENCH] =
        {"bench", "[ROOM] [--quick] [--scene SCENE] [--markdown]", "measure speed and accuracy", -1,
         command_bench,
         "Measures this machine: in turns, what the hardware and the ray tracer give at most, and "
         "what alpenglow makes of it, as a ratio of medians. ROOM is trace (building), transport "
         "(the innermost loop), atlas, maps (error per second), accuracy (stated against true "
         "errors), truth (each technique against the reference), denoise, bounced (ways to gather "
         "bounced light), light (its rays against the ray tracer, its bakes by workers and size) "
         "or formats (reading); without it all are run, which takes more than half an hour. Other "
         "work on the "
         "machine makes the figures worse and the "
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
    return command == COMMAND_BAKE || command == COMMAND_RENDER;
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
