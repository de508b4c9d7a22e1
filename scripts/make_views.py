#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes a sheet of the viewer in docs/gallery.md: every mode of one scene, beside the reference.

    scripts/make_views.py ALPENGLOW OUT.png SCENE

SCENE is one of the table SCENES below. zdm2 is read from $ALPENGLOW_SHARED. All pictures with light
have the exposure of the reference.
"""
import os
import re
import subprocess
import sys
import tempfile

from png_rows import read_png, write_png

SIZE = "240x135"
SUN = ["--sky", "clear", "--sun", "150,40,60000"]
SCENES = {  # name: scene, camera, its light, options of its light maps, mist
    "cornell": ("builtin:cornell", "0.278,0.273,-0.3,0.278,0.273,0.28,68",
                ["--lamp", "0.4,0.35,0.15,0.1"], [], "0.5"),
    "teapot-room": ("builtin:teapot-room", "1.75,1.7,1.7,-0.12,0.74,-0.6,50",
                    ["--lamp", "0.4,2,1,6"], ["--size", "1024"], "0.05"),
    "terrain": ("builtin:terrain", "-50,5,18,20,3,-4,40", SUN, [], "0.002"),
    "zdm2": ("$ALPENGLOW_SHARED/scenes/architecture/zdm2.glb", "10,24,-10,20,0,5,70", SUN,
             [], "0.005"),
}
PATHS = {"cornell": "512", "teapot-room": "512", "terrain": "64", "zdm2": "64"}  # of the reference
PLACES = [["--read", place] for place in ("pixel", "vertex", "object")]
MAPS = ("lightmap", "sh", "blend")
UNLIT = ("none", "ao", "albedo")  # modes without suns and lamps
REFERENCE = ["reference"]
SHEET = [  # rows of modes with their options
    [*(["probes", *place] for place in PLACES), REFERENCE],
    [*(["ambience", *place] for place in PLACES), ["lightmap"]],
    [*(["lpv", *place] for place in PLACES), ["sh"]],
    [["constant"], ["hemisphere"], ["ground-map"], ["ambient-cube"]],
    [["environment"], ["direct"], ["blend"], ["ao"]],
    [["albedo"], ["none"], ["lpv", "--gloss"], ["lpv", "--media"]],
]


def options_of(cell, scene):
    """Options of one cell of the sheet."""
    _, camera, light, maps, mist = SCENES[scene]
    options = ["--with", *cell, *([mist] if cell[-1] == "--media" else []), "--camera", camera]
    if cell[0] == "ambience":  # the volume is where the camera is
        options += ["--path", "-"]
    if cell[0] in MAPS:
        options += maps
    if cell[0] == "lpv":  # holds no sky
        light = [option for option in light if option not in ("--sky", "clear")]
    return options if cell[0] in UNLIT else options + light


def picture(command, verb, scene, options):
    """Rows of one picture, and its exposure."""
    path, camera = os.path.expandvars(SCENES[scene][0]), SCENES[scene][1]
    flight = "0," + camera.rpartition(",")[0] + "\n"
    with tempfile.TemporaryDirectory() as folder:
        out = folder + "/picture.png"
        done = subprocess.run([command, verb, path, "-o", out, "--resolution", SIZE, *options],
                              check=True, stdout=subprocess.PIPE, input=flight, text=True)
        exposure = re.search(r"^exposure +(\S+)", done.stdout, re.MULTILINE)
        return read_png(out), exposure and exposure[1]


def main():
    if len(sys.argv) != 4 or sys.argv[3] not in SCENES:
        sys.exit(__doc__)
    command, out, scene = sys.argv[1:]
    truth, exposure = picture(command, "render", scene,
                              [*options_of(REFERENCE, scene), "--samples", PATHS[scene]])
    rows = []
    for cells in SHEET:
        strip = []
        for cell in cells:
            if cell is REFERENCE:
                strip.append(truth)
                continue
            options = options_of(cell, scene)
            if cell[0] not in ("ao", "albedo"):
                options += ["--exposure", exposure]
            strip.append(picture(command, "view", scene, options)[0])
        rows += [b"".join(parts) for parts in zip(*strip)]
    write_png(out, rows)


main()
