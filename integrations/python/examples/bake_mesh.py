# SPDX-License-Identifier: MIT
"""Bakes a mesh from arrays: a room with a lit panel, its light as a picture.

    python bake_mesh.py [PICTURE.png]
"""
import sys

import numpy

import alpenglow


def box(low, high, inwards=False):
    """(positions [8, 3], triangles [12, 3]) of a box with corners `low` and `high`, in metres."""
    corners = numpy.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = numpy.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    return low + corners * numpy.subtract(high, low), triangles[:, ::-1] if inwards else triangles


class Progress:
    """Prints each stage, and its progress in steps of a tenth."""

    def __init__(self):
        self.printed = None

    def __call__(self, progress):
        state = (progress.stage, 10 * progress.done // max(progress.total, 1))
        if state != self.printed:
            self.printed = state
            print(f"{state[0]} {10 * state[1]} %", file=sys.stderr)


def main(path):
    scene = alpenglow.Scene.from_meshes([
        alpenglow.Mesh(*box((0, 0, 0), (4, 2.5, 3), inwards=True), albedo=(0.7, 0.6, 0.5), name="room"),
        alpenglow.Mesh(*box((1.5, 0, 1), (2.5, 0.8, 2)), albedo=(0.2, 0.3, 0.7), name="table"),
        alpenglow.Mesh(*box((1.5, 2.4, 1), (2.5, 2.45, 2)), albedo=0, emission=20, name="panel")])
    lightmap = scene.bake(size=128, maps=("ao", "light"), progress=Progress())
    light, report = lightmap.irradiance, lightmap.report
    covered = lightmap.coverage > 0.5
    print(f"{covered.sum()} texels, mean {light[covered].mean():.2f} W/m2, "
          f"error {100 * report['light_relative_error']:.1f} %, {report['seconds_total']:.1f} s")
    seen = (1 - numpy.exp(-light / light[covered].mean())) ** (1 / 2.2)
    alpenglow.save_image(path, numpy.round(255 * seen).astype(numpy.uint8), overwrite=True)
    u, v = lightmap.uvs[0].mean(axis=0)  # the middle of triangle 0, and its texel
    height, width = covered.shape
    print("triangle 0:", light[int(v * height), int(u * width)], "W/m2")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "light.png")
