#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints how far values differ across seams, as baked and stitched, as a table.

    tests/truth/seams.py ALPENGLOW [SCENE ...]

Each scene is baked at 512 x 512 to a stated error of 1 % on charts of its own. Without scenes those
of the proof: builtin:teapot-room, builtin:sphere-plane, builtin:torus-plane."""
import json
import subprocess
import sys
import tempfile

SCENES = ["builtin:teapot-room", "builtin:sphere-plane", "builtin:torus-plane"]


def bake(command, scene):
    with tempfile.TemporaryDirectory() as folder:
        out = subprocess.run(
            [command, "bake", scene, "--atlas", "charts", "--size", "512", "--maps", "ao,light",
             "--sky", "1,1,1", "--error", "1", "--maps-dir", folder, "-f", "-q", "--progress", "off",
             "--json", "-"], check=True, stdout=subprocess.PIPE)
    return json.loads(out.stdout)


def main():
    command, scenes = sys.argv[1], sys.argv[2:] or SCENES
    print("| scene | charts | seams, m | map | noise | mean | 99 % | stitched mean | 99 % |")
    print("|---|---|---|---|---|---|---|---|---|")
    for scene in scenes:
        report = bake(command, scene)
        seams = report["seams"]
        for name, of_map in seams["maps"].items():
            figures = [report["error"][name]["relative"], of_map["mean"], of_map["p99"],
                       of_map["stitched_mean"], of_map["stitched_p99"]]
            cells = [scene, str(report["atlas"]["charts"]), f"{seams['length']:.1f}", name]
            cells += [f"{100 * f:.2g} %" for f in figures]
            print("| " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
