#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders borders of charts four ways and puts the pictures in rows.

    scripts/make_borders.py ALPENGLOW OUT.png

Columns: charts as baked, charts stitched, overlapping charts blended by the normal, and their plain
average. Rows: a sphere on its plane, the handle and the spout of the teapot
in its room. Grey; contrast is raised about the mean of the middle of the first
picture of a row. `make gallery` calls it.
"""
import subprocess
import sys
import tempfile

from png_rows import read_png, write_png

WIDTH, HEIGHT = 240, 180  # of one picture
WAYS = [["charts", "off"], ["charts", "on"], ["blend", "off"], ["average", "off"]]
VIEWS = [  # scene, options, contrast
    ["builtin:sphere-plane", ["--size", "64", "--sky", "1,1,1", "--bounces", "0", "--camera",
                              "1.1,1.3,1.1,-0.02,0.38,0.3,11"], 5],
    ["builtin:teapot-room", ["--size", "256", "--camera", "0.1,1.3,1.7,-0.16,0.97,0,10"], 3],
    ["builtin:teapot-room", ["--size", "256", "--camera", "0.1,1.3,1.7,0.29,1.03,0,10"], 3],
]


def to_grey(rows):
    return [[(299 * row[i] + 587 * row[i + 1] + 114 * row[i + 2]) // 1000
             for i in range(0, len(row), 3)] for row in rows]


def middle_mean(grey):
    part = [v for row in grey[HEIGHT // 4 : 3 * HEIGHT // 4]
            for v in row[WIDTH // 4 : 3 * WIDTH // 4]]
    return sum(part) / len(part)


def raise_contrast(grey, mean, factor):
    table = [bytes([max(0, min(255, round(128 + factor * (i - mean))))] * 3) for i in range(256)]
    return [b"".join(table[v] for v in row) for row in grey]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    command, out = sys.argv[1:3]
    sheet = []
    with tempfile.TemporaryDirectory() as folder:
        for scene, options, contrast in VIEWS:
            pictures = []
            for atlas, stitch in WAYS:
                picture = folder + "/picture.png"
                subprocess.run([command, "render", scene, "--with", "lightmap", "--atlas", atlas,
                                "--stitch", stitch, "-o", picture, "-f", "-q", "--exposure", "0",
                                "--tone", "none", "--resolution", f"{WIDTH}x{HEIGHT}", *options],
                               check=True)
                pictures.append(to_grey(read_png(picture)))
            mean = middle_mean(pictures[0])
            raised = [raise_contrast(p, mean, contrast) for p in pictures]
            sheet += [b"".join(p[y] for p in raised) for y in range(HEIGHT)]
    write_png(out, sheet)


main()
