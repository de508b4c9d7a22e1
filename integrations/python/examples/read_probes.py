# SPDX-License-Identifier: MIT
"""Bakes probes of a room, and reads the irradiance of a thing that moves through it.

    python read_probes.py [SCENE]
"""
import sys

import numpy

import alpenglow


def main(path):
    scene = alpenglow.Scene.load(path)
    low, high = (numpy.array(scene.info[name]) for name in ("bounds_min", "bounds_max"))
    probes = alpenglow.Probes.bake(scene, spacing=float((high - low).max() / 10))
    info = probes.info
    print(f"{info['count']} probes, {info['states']['moved']} of them moved out of solids, "
          f"stated error {100 * info['error']:.1f} %")
    way = numpy.linspace(low + 0.2 * (high - low), low + 0.8 * (high - low), 5)
    up = numpy.tile([0.0, 1.0, 0.0], (len(way), 1))
    for place, light in zip(way, probes.sample(way, up)):
        print("at {:.2f} {:.2f} {:.2f}: {:.3f} {:.3f} {:.3f} W/m2".format(*place, *light))


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "builtin:cornell")
