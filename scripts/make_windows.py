#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders builtin:windows, whose only light is a small sun outside, bounce by bounce, and puts the
pictures on one sheet.

    scripts/make_windows.py ALPENGLOW OUT.png [PATHS]

The story is that of Hugo Elias, Radiosity: direct light beside all light; and the room after pass 1,
2, 3 and 16. All pictures have one exposure. PATHS are the paths of a pixel in the large pictures
(default 1024); small ones have four times as many. 1024 take several minutes. docs/gallery.md explains
the pictures. `make gallery GALLERY=windows` calls it.
"""
import subprocess
import sys
import tempfile

from png_rows import read_png, write_png

WIDTH, HEIGHT = 192, 128  # of a small picture; large ones have twice the side
CAMERA = "-3.8,3.0,2.8,0.55,0.7,-0.8,66"
EXPOSURE = "1.5"
# Almost no light, for a black night: without a sky the background is grey.
NIGHT = "1e-6,1e-6,1e-6"
LARGE = ["0", "converge"]  # bounces
SMALL = ["0", "1", "2", "15"]  # passes 1, 2, 3 and 16


def render(command, bounces, scale, paths, folder):
    picture = folder + "/picture.png"
    subprocess.run([command, "render", "builtin:windows", "--with", "reference", "-o", picture,
                    "--camera", CAMERA, "--resolution", f"{scale * WIDTH}x{scale * HEIGHT}",
                    "--bounces", bounces, "--samples", str(paths), "--sky", NIGHT,
                    "--exposure", EXPOSURE, "--tone", "film", "-f", "-q"], check=True)
    return read_png(picture)


def side_by_side(pictures):
    return [b"".join(rows) for rows in zip(*pictures)]


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    command, out = sys.argv[1:3]
    paths = int(sys.argv[3]) if len(sys.argv) == 4 else 1024
    with tempfile.TemporaryDirectory() as folder:
        sheet = side_by_side([render(command, b, 2, paths, folder) for b in LARGE])
        sheet += side_by_side([render(command, b, 1, 4 * paths, folder) for b in SMALL])
    write_png(out, sheet)


main()
