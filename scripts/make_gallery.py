#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the pictures of docs/gallery.md.

    scripts/make_gallery.py ALPENGLOW FOLDER [NAME ...]

ALPENGLOW is a release build of the command, FOLDER takes the pictures (docs/pictures). NAMEs are
those of the table PICTURES below; without them all pictures that take less than two minutes each.
"""
import os
import subprocess
import sys
import tempfile

from png_rows import read_png, write_png

HERE = os.path.dirname(os.path.abspath(__file__))
WIDTH, HEIGHT = 320, 180  # of one picture of the strip
SUN = ["--sky", "clear", "--sun", "335,50,60000"]
# Sun and sky need one exposure, so that direct light and all light compare.
LIT = ["--with", "lightmap", "--size", "1024", *SUN, "--exposure", "-12.3"]
STRIP = [
    ["--with", "albedo"],
    ["--with", "ao", "--ao-samples", "1024"],
    [*LIT, "--bounces", "0"],
    [*LIT],
]


def atrium(command, out):
    """The atrium under sun and sky, in a row: albedo, occlusion, direct light, all light."""
    pictures = []
    with tempfile.TemporaryDirectory() as folder:
        for options in STRIP:
            picture = folder + "/picture.png"
            subprocess.run([command, "render", "builtin:atrium", "-o", picture, "-f", "-q",
                            "--resolution", f"{WIDTH}x{HEIGHT}", "--samples", "64", *options],
                           check=True)
            pictures.append(read_png(picture))
    write_png(out, [b"".join(rows) for rows in zip(*pictures)])


def teapot_room(command, out):
    """The teapot room with its own lamp, as its light map shows it."""
    subprocess.run([command, "render", "builtin:teapot-room", "-o", out, "-f", "-q", "--with",
                    "lightmap", "--size", "1024", "--resolution", "640x360", "--samples", "64"],
                   check=True)


def row(command, out, options, variants):
    """Renders of one scene with one exposure, side by side."""
    pictures = []
    with tempfile.TemporaryDirectory() as folder:
        for variant in variants:
            picture = folder + "/picture.png"
            subprocess.run([command, "render", *options, "-o", picture, "-f", "-q", "--resolution",
                            f"{WIDTH}x{HEIGHT}", "--with", *variant], check=True)
            pictures.append(read_png(picture))
    write_png(out, [b"".join(rows) for rows in zip(*pictures)])


def space(command, out):
    """The teapot room by models of light in space, in a row; a white ball is lit by each."""
    row(command, out, ["builtin:teapot-room", "--samples", "64", "--exposure", "0", "--object",
                       "sphere,0.9,0.25,-0.2,0.25"],
        [["constant"], ["environment"], ["probes", "--spacing", "0.25"],
         ["reference", "--samples", "256"]])


def propagation(command, out):
    """The atrium in the sun by light propagation: two modes, mist, the reference."""
    row(command, out, ["builtin:atrium", "--sun", "40,50,20", "--direct", "on", "--samples", "16",
                       "--exposure", "1.3"],
        [["lpv"], ["lpv", "--mode", "conformance"], ["lpv", "--media", "0.015"],
         ["reference", "--samples", "1024"]])


def viewer(_, out):
    """Four pictures of the viewer's sheet of the teapot room, in a row."""
    sheet = read_png(os.path.join(os.path.dirname(out), "view-teapot-room.png"))
    width, height = 240, 135
    cells = [[row[3 * width * x:3 * width * (x + 1)] for row in sheet[height * y:height * (y + 1)]]
             for y, x in ((4, 1), (2, 0), (0, 0), (0, 3))]
    write_png(out, [b"".join(rows) for rows in zip(*cells)])


def web_page(command, out):
    """The page of alpenglow web of the atrium under sun and sky, in Chromium."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([command, "bake", "builtin:atrium", "-o", "atrium.glb", "-q", "--maps",
                        "light,ao", "--size", "1024", *SUN, "--layers", "--maps-dir", "maps",
                        "--lightmap-as", "extras"], cwd=folder, check=True)
        subprocess.run([command, "lpv", "builtin:atrium", "-q", "--frames", "1", *SUN[2:],
                        "--volume", "atrium.lpv.json"], cwd=folder, check=True)
        subprocess.run([command, "web", "atrium.glb", "atrium.html", "-q", "--maps-dir", "maps",
                        "--volume", "atrium.lpv.json"], cwd=folder, check=True)
        subprocess.run(["node", os.path.join(HERE, "../tests/browser/shoot.mjs"),
                        folder + "/atrium.html", out, "1200", "675", "0.625"], check=True)
    write_png(out, read_png(out))  # a smaller file


def script(name, *arguments):
    return lambda command, out: subprocess.run(
        [sys.executable, os.path.join(HERE, name), command, out, *arguments], check=True)


PICTURES = {  # name: how it is made, and whether it is quick
    "atrium": (atrium, True),
    "teapot-room": (teapot_room, True),
    "space": (space, True),
    "propagation": (propagation, True),
    "plates": (script("make_plates.py"), True),
    "blend-borders": (script("make_borders.py"), True),
    "windows": (script("make_windows.py", "192"), False),
    **{f"view-{scene}": (script("make_views.py", scene), False)
       for scene in ("cornell", "teapot-room", "terrain", "zdm2")},
    "viewer": (viewer, True),
    "web_page": (web_page, False),
}


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    command, folder = os.path.abspath(sys.argv[1]), sys.argv[2]
    names = sys.argv[3:] or [name for name, (_, quick) in PICTURES.items() if quick]
    for name in names:
        if name not in PICTURES:
            sys.exit(f"make_gallery: no picture {name}; there are {', '.join(PICTURES)}")
    os.makedirs(folder, exist_ok=True)
    for name in names:
        out = os.path.join(folder, name + ".png")
        PICTURES[name][0](command, out)
        print(out, flush=True)


main()
