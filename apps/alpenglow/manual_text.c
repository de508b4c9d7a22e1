// SPDX-License-Identifier: MIT
// Files and examples of the manual pages. Options are not named here but in examples.
#include "manual_text.h"

static const manual_text texts[COMMAND_COUNT + 1] = {
    [COMMAND_BAKE] =
        {.failed = "A file could not be read or written, SCENE holds nothing to bake, or a "
                   "warning came under --warnings-as-errors. Nothing was written.",
         .files = {{"OUT.glb, OUT.gltf, OUT.dae",
                    "SCENE with the occlusion map attached to its materials."},
                   {"OUT.bin, OUT.ao.bin, OUT.ao.png, OUT.ao.1.png",
                    "What an OUT.gltf refers to: geometry, what the bake adds to it, and the map's "
                    "pages."},
                   {"OUT.obj, OUT.mtl, OUT.ao.png", "The same as OBJ, its materials and the map."},
                   {"DIR/ao.exr, DIR/ao.png, DIR/ao.1.exr", "The map's pages as files."}},
         .examples =
             {{"Bake a scene for a viewer:", "alpenglow bake scene.glb -o baked.glb"},
              {"A built-in scene, with its map as files too:",
               "alpenglow bake builtin:teapot-room -o room.glb --size 512 --maps-dir maps"},
              {"Small corners only, darkest where surfaces touch:",
               "alpenglow bake scene.glb -o corners.glb --ao-distance 0.2 --ao-falloff exp"},
              {"The map and a report of the bake, no scene:",
               "alpenglow bake scene.glb --maps-dir only-maps --json report.json"},
              {"A page that shows the bake, its errors and what it warned of:",
               "alpenglow bake scene.glb -o baked.glb --report bake.html"}}},
    [COMMAND_RENDER] = {.failed = "A file could not be read or written, or a warning came under "
                                  "--warnings-as-errors. Nothing was written.",
                        .files = {{"IMAGE.png", "The picture as a screen shows it."},
                                  {"IMAGE.exr, IMAGE.hdr", "Its linear values."}},
                        .examples = {{"Look at a bake:",
                                      "alpenglow render baked.glb --with ao -o picture.png"},
                                     {"From a place of your own, in linear values:",
                                      "alpenglow render builtin:cornell --with ao -o cornell.exr "
                                      "--camera 0.5,0.5,2,0.5,0.5,0,40"}}},
    [COMMAND_INFO] = {.failed = "SCENE could not be read.",
                      .examples = {{"What is in a file:", "alpenglow info scene.glb"},
                                   {"For a program to read:",
                                    "alpenglow info builtin:cornell --json"}}},
    [COMMAND_COMPARE] =
        {.failed =
             "A file could not be read or written, the images differ in size or the scenes in "
             "their triangles, a scene has no map, or they differ by more than --max-rmse "
             "allows.",
         .files = {{"A, B", "Images to read: .exr, .hdr, .png or .jpg; or scenes: .glb, .gltf, "
                            ".dae, .zae or .obj."},
                   {"PNG", "The picture of the difference."}},
         .examples = {{"Hold two bakes against each other, as a test does:",
                       "alpenglow compare maps/ao.exr maps/ao.exr --max-rmse 0.01"},
                      {"See where they differ:",
                       "alpenglow compare maps/ao.exr maps/ao.exr --heatmap difference.png"},
                      {"Hold the maps of two assets against each other:",
                       "alpenglow compare baked.glb baked.glb --map ao"}}},
    [COMMAND_BENCH] =
        {.failed = "The program that measures, alpenglow-bench, is not installed, or a scene could "
                   "not be read.",
         .examples = {{"Measure everything:", "alpenglow bench"},
                      {"Only whether it runs:", "alpenglow bench --quick"},
                      {"The innermost loop on a scene of yours:",
                       "alpenglow bench transport --scene scene.glb"}}},
    [COMMAND_COUNT] = {.failed =
                           "The command failed; a message on standard error says what and where.",
                       .files = {{"*.gltf, *.glb, *.obj, *.dae, *.zae",
                                  "Scenes, read and written (a .zae is read)."},
                                 {"*.exr", "Maps and pictures in linear float."},
                                 {"*.png", "Maps and pictures of 8 bits."}},
                       .examples = {{"From a scene to a picture of it with its occlusion baked:",
                                     "alpenglow bake builtin:teapot-room -o room.glb --size 512"},
                                    {"and then", "alpenglow render room.glb --with ao -o room.png"},
                                    {"Completion in the bash that runs, where it is not installed:",
                                     "source <(alpenglow --completion bash)"}}},
};

const manual_text *manual_text_of(command_id command)
{
    return &texts[command];
}
