#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Bakes and renders one scene with one option changed at a time and puts the pictures in rows.

    scripts/make_plates.py ALPENGLOW OUT.png [SCENE]

Rows as in chapter 7 of I. R. Hafthorsson, Ambient Occlusion Using Ray-tracing and Texture Blending
(DTU 2007): number of rays, distance, fall-off, and distribution and cone. docs/gallery.md explains
them. `make gallery` calls it.
"""
import subprocess
import sys
import tempfile

from png_rows import read_png, write_png

SIZE = 256  # of one picture
ROWS = [
    [["--ao-samples", n, "--adaptive", "off"] for n in ("4", "16", "64", "256", "1024")],
    [["--ao-distance", d] for d in ("0.1", "0.3", "1", "3")]
    + [["--ao-distance", "inf", "--ao-falloff", "none"]],
    [["--ao-falloff", f] for f in ("none", "linear", "smooth", "exp")]
    + [["--ao-falloff", "none", "--one-sided"]],
    [["--ao-distribution", "cosine"], ["--ao-distribution", "uniform"]]
    + [["--ao-cone", a] for a in ("70", "45", "20")],
]


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    command, out = sys.argv[1:3]
    scene = sys.argv[3] if len(sys.argv) == 4 else "builtin:torus-plane"
    sheet = []
    with tempfile.TemporaryDirectory() as folder:
        for options in ROWS:
            pictures = []
            for option in options:
                baked, picture = folder + "/baked.glb", folder + "/picture.png"
                subprocess.run([command, "bake", scene, "-o", baked, "--size", "512", "-f", "-q",
                                *option], check=True)
                subprocess.run([command, "render", baked, "--with", "ao", "-o", picture, "-f", "-q",
                                "--resolution", f"{SIZE}x{SIZE}"], check=True)
                pictures.append(read_png(picture))
            sheet += [b"".join(p[y] for p in pictures) for y in range(SIZE)]
    write_png(out, sheet)


main()
