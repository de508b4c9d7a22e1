// SPDX-License-Identifier: MIT
// Files and examples of the manual pages. Options are named only in examples.
#include "help/manual_text.h"

static const manual_text texts[COMMAND_COUNT + 1] = {
    [COMMAND_BAKE] =
        {.failed = "A file could not be read or written, SCENE has nothing to bake, or "
                   "--warnings-as-errors stopped at a warning. Nothing was written.",
         .files = {{"OUT.glb, OUT.gltf, OUT.dae", "SCENE with the maps attached to its materials."},
                   {"OUT.bin, OUT.bake.bin, OUT.ao.png, OUT.ao.1.png",
                    "Files of an OUT.gltf: geometry, data that the bake adds, and pages of the "
                    "map."},
                   {"OUT.obj, OUT.mtl, OUT.ao.png",
                    "The same as OBJ: geometry, materials and the map."},
                   {"DIR/ao.exr, DIR/ao.png, DIR/ao.1.exr", "Pages of the maps as files."}},
         .examples =
             {{"Bake a scene for a viewer:", "alpenglow bake scene.glb -o baked.glb"},
              {"Bake a built-in scene, and write its map as files too:",
               "alpenglow bake builtin:teapot-room -o room.glb --size 512 --maps-dir maps"},
              {"Bake small corners only, darkest near contacts:",
               "alpenglow bake scene.glb -o corners.glb --ao-distance 0.2 --ao-falloff exp"},
              {"Write the map and a report of the bake, without a scene:",
               "alpenglow bake scene.glb --maps-dir only-maps --json report.json"},
              {"Write a page with the maps, their errors and the warnings:",
               "alpenglow bake scene.glb -o baked.glb --report bake.html"}}},
    [COMMAND_RENDER] = {.failed = "A file could not be read or written, or --warnings-as-errors "
                                  "stopped at a warning. Nothing was written.",
                        .files = {{"IMAGE.png", "The picture for display, 8-bit sRGB."},
                                  {"IMAGE.exr, IMAGE.hdr", "The picture in linear values."}},
                        .examples = {{"Render a bake:",
                                      "alpenglow render baked.glb --with ao -o picture.png"},
                                     {"Render linear values from a camera of your own:",
                                      "alpenglow render builtin:cornell --with ao -o cornell.exr "
                                      "--camera 0.5,0.5,2,0.5,0.5,0,40"}}},
    [COMMAND_INFO] = {.failed = "SCENE could not be read.",
                      .examples = {{"List the contents of a file:", "alpenglow info scene.glb"},
                                   {"Print them for a program:",
                                    "alpenglow info builtin:cornell --json"}}},
    [COMMAND_COMPARE] =
        {.failed =
             "A file could not be read or written. The images differ in size, or the scenes in "
             "their triangles. A scene has no map. Or rmse is above --max-rmse.",
         .files = {{"A, B", "Images (.exr, .hdr, .png or .jpg) or scenes (.glb, .gltf, .dae, "
                            ".zae or .obj) to compare."},
                   {"PNG", "The picture of the difference."}},
         .examples = {{"Compare two bakes, as in a test:",
                       "alpenglow compare maps/ao.exr maps/ao.exr --max-rmse 0.01"},
                      {"Draw the difference:",
                       "alpenglow compare maps/ao.exr maps/ao.exr --heatmap difference.png"},
                      {"Compare the maps of two assets:",
                       "alpenglow compare baked.glb baked.glb --map ao"}}},
    [COMMAND_SAMPLE] =
        {.failed =
             "The scene, POINTS or the probes could not be read, or nothing lights the scene.",
         .files = {{"SCENE", "Scene to measure, or a built-in scene."},
                   {"POINTS.csv", "Points: a line x,y,z,nx,ny,nz each."},
                   {"FILE.probes.json", "Probes, as alpenglow probes writes them."}},
         .examples =
             {{"Measure the light above the floor of a room, by path tracing:",
               "echo 0.28,0.1,0.2,0,1,0 | alpenglow sample builtin:cornell --with reference "
               "--at -"},
              {"Measure it by probes 10 cm apart:",
               "echo 0.28,0.1,0.2,0,1,0 | alpenglow sample builtin:cornell --with probes "
               "--spacing 0.1 --at -"}}},
    [COMMAND_PROBES] =
        {.failed =
             "The scene or POINTS could not be read, nothing lights the scene, there would be "
             "too many probes, or the files could not be written.",
         .files = {{"SCENE", "Scene to bake, or a built-in scene."},
                   {"OUT.probes.json", "Grid, units, content and quality of the probes."},
                   {"OUT.probes.ktx2", "Their light."},
                   {"OUT.probes.moments.ktx2", "Distances to surfaces around them."},
                   {"OUT.three.mjs, OUT.three.ktx2", "The same for three.js (--export three)."}},
         .examples = {{"Bake probes 20 cm apart:",
                       "alpenglow probes builtin:cornell --spacing 0.2 -o room.probes.json"},
                      {"Bake them for three.js:",
                       "alpenglow probes builtin:cornell --spacing 0.2 --export three -f -o "
                       "room.probes.json"}}},
    [COMMAND_AMBIENCE] =
        {.failed = "The scene or FLIGHT could not be read, nothing lights the scene, or a file "
                   "could not be written.",
         .files = {{"SCENE", "Scene to fly through, or a built-in scene."},
                   {"FLIGHT.csv", "The flight: lines of t,px,py,pz,tx,ty,tz[,vfov]."},
                   {"DIR/frame_0001.png", "The picture of the first second (--pictures)."},
                   {"DIR/preview.png", "An object at moments of the flight (--preview)."}},
         .examples = {{"Fly through the built-in terrain under a clear sky:",
                       "alpenglow ambience builtin:terrain --sky clear --sun 40,30,80000"},
                      {"Fly there through a day of 20 seconds, and write a line for each second:",
                       "alpenglow ambience builtin:terrain --sky clear --sun 40,50,80000 --day 20 "
                       "--csv flight.csv"}}},
    [COMMAND_LPV] =
        {.failed = "The scene could not be read, nothing lights it, the volume would need too much "
                   "memory, or a file could not be written.",
         .files = {{"SCENE", "Scene to light, or a built-in scene."},
                   {"DIR/slice_x.png, DIR/slice_y.png, DIR/slice_z.png",
                    "Fluence in the middle layers of the grid (--pictures)."},
                   {"DIR/view.png", "A view lit by the volume, beside the reference."},
                   {"FILE.lpv.json", "Fluence in all cells (--volume)."}},
         .examples = {{"Measure a frame of light in a hall under a turning sun:",
                       "alpenglow lpv builtin:atrium --sun 30,60,80000"},
                      {"Draw the light in three grids inside each other:",
                       "alpenglow lpv builtin:atrium --sun 30,60,80000 --cascades 3 --frames 1 "
                       "--pictures slices"}}},
    [COMMAND_SH] = {.failed = "ENV could not be read or is no equirectangular float image, or the "
                              "image could not be written.",
                    .files = {{"ENV", "Environment to project (.hdr or .exr)."},
                              {"IMAGE.hdr, IMAGE.exr, IMAGE.png", "The irradiance map."}},
                    .examples = {{"Print the coefficients of a LightProbe of three.js:",
                                  "alpenglow sh sky.hdr"},
                                 {"Print those of Filament, and write the irradiance map:",
                                  "alpenglow sh sky.hdr --convention filament -o irradiance.hdr"}}},
    [COMMAND_STATUS] = {.failed = "DIR has no checkpoint, or cannot be read.",
                        .files = {{"DIR/NAME.state", "State of a process: text, with a checksum."},
                                  {"DIR/NAME.tiles", "Its finished work."}},
                        .examples = {{"Print the progress of a bake that runs elsewhere:",
                                      "alpenglow status work"}}},
    [COMMAND_MERGE] =
        {.failed = "Shards are missing, which the message lists, or the result could not be "
                   "written.",
         .files = {{"DIR/shard-I.state, DIR/shard-I.tiles", "State and tiles of a shard."}},
         .examples = {{"Write the result of a job array:", "alpenglow merge work -o baked.glb"}}},
    [COMMAND_WEB] =
        {.failed = "BAKED could not be read, the page could not be written, or this alpenglow was "
                   "built without three.js.",
         .files = {{"BAKED.glb, BAKED.gltf", "The scene, and the files that it names."},
                   {"DIR/irradiance.NAME.exr", "The map of a single light (--maps-dir)."},
                   {"FILE.probes.json, FILE.probes.ktx2", "Probes (--probes)."},
                   {"FILE.lpv.json", "Light in space (--volume)."},
                   {"OUT.html", "The page, with all of that inside."},
                   {"REPORT.html", "The report that gets a link to the page (--report)."}},
         .examples = {{"Write a baked scene as a page:", "alpenglow web scene.glb -o scene.html"}}},
    [COMMAND_BENCH] =
        {.failed = "The measuring program, alpenglow-bench, is not installed, or a scene could not "
                   "be read.",
         .examples = {{"Measure everything:", "alpenglow bench"},
                      {"Test that it runs:", "alpenglow bench --quick"},
                      {"Measure the innermost loop on a scene of your own:",
                       "alpenglow bench transport --scene scene.glb"}}},
    [COMMAND_VIEW] =
        {.failed = "A file could not be read or written, the viewing program, alpenglow-view, is "
                   "not installed, there is no OpenGL 4.5, the picture differs from the reference "
                   "by more than the threshold, or --warnings-as-errors stopped at a warning.",
         .files = {{"IMAGE.png",
                    "The picture for display, 8-bit sRGB. Its texts Software, Command, "
                    "Camera, Exposure and OpenGL say how it was made."},
                   {"IMAGE.exr, IMAGE.hdr", "The picture in linear values."},
                   {"FLIGHT.csv", "The flight: lines of t,px,py,pz,tx,ty,tz[,vfov]."},
                   {"DIR/frame_0001.png", "The first picture of a flight."}},
         .examples = {{"Draw a scene with a light map:",
                       "alpenglow view builtin:cornell --with lightmap -o picture.png"},
                      {"Draw it again, and compare:",
                       "alpenglow view builtin:cornell --with lightmap -o again.png "
                       "--reference picture.png --reference-threshold 0.01"}}},
    [COMMAND_COUNT] =
        {.failed = "The command failed. A message on standard error names the fault and its place.",
         .files = {{"*.gltf, *.glb, *.obj, *.dae, *.zae",
                    "Scenes, read and written (.zae: read only)."},
                   {"*.exr", "Maps and pictures in linear float."},
                   {"*.png", "Maps and pictures in 8 bits."}},
         .examples = {{"Bake the occlusion of a scene,",
                       "alpenglow bake builtin:teapot-room -o room.glb --size 512"},
                      {"and render a picture of it:",
                       "alpenglow render room.glb --with ao -o room.png"},
                      {"Enable completion in the running bash, if it is not installed:",
                       "source <(alpenglow --completion bash)"}}},
};

const manual_text *manual_text_of(command_id command)
{
    return &texts[command];
}
