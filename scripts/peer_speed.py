#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Seconds to the same error as Blender's Cycles, on the same texels, in one run.

    scripts/peer_speed.py ALPENGLOW SHARED [SCENE ...]

SHARED is the folder with peers/blender/bake_peer.py. Each scene is baked once by ours, so that it has
texture coordinates; then Cycles bakes those texels at 256 samples with two seeds (its error is the
difference over root two), and ours with more and more rays until its error, against its own
converged map, is no larger. Seconds: of Cycles the bake alone, of ours atlas, build and sampling.
Distance limit 0.2 of a metre or as given by SCENE=DISTANCE, no fall-off. Needs Blender and numpy.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

SCENES = ["{shared}/peers/blender/cornell.glb", "{shared}/peers/blender/sphere_plane.glb",
          "builtin:torus-plane=0.5", "builtin:teapot-room=0.5"]
RAYS = [64, 80, 96, 112, 128, 160, 192, 224, 256, 288, 320, 384, 448, 512, 640, 768, 1024]
SIZE = 256


def run(*words):
    subprocess.run([str(w) for w in words], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)


def ours(command, scene, distance, folder, *options):
    maps = os.path.join(folder, "maps")
    run(command, "bake", scene, "--maps-dir", maps, "--size", SIZE, "--ao-distance", distance,
        "--ao-falloff", "none", "--json", folder + "/ours.json", "-f", "-q", *options)
    seconds = json.load(open(folder + "/ours.json"))["seconds"]
    return maps + "/ao.exr", seconds["atlas"] + seconds["build"] + seconds["bake"]


def difference(command, a, b, folder):
    run(command, "compare", a, b, "--json", folder + "/difference.json", "-f", "-q")
    found = json.load(open(folder + "/difference.json"))
    return found["rmse"], found["maximum"]


def cycles(shared, scene, uv, distance, seed, folder):
    out, report = f"{folder}/cycles{seed}.exr", f"{folder}/cycles.json"
    environment = dict(os.environ, PATH="/usr/bin:/bin")  # the Python that has numpy
    subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "3", "--python",
                    shared + "/peers/blender/bake_peer.py", "--", "--scene", scene, "--type", "ao",
                    "--size", str(SIZE), "--samples", "256", "--seed", str(seed), "--ao-distance",
                    str(distance), "--uv", f"TEXCOORD_{uv}", "--out", out, "--json", report],
                   check=True, env=environment, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    return out, json.load(open(report))["seconds"]


def measure(command, shared, name):
    scene, _, distance = name.partition("=")
    scene, distance = scene.format(shared=shared), distance or "0.2"
    with tempfile.TemporaryDirectory() as folder:
        baked, uv = scene, 1
        if not scene.endswith(".glb"):
            baked, uv = folder + "/scene.glb", 0
            run(command, "bake", scene, "-o", baked, "--size", SIZE, "--ao-samples", 4, "-q")
        first, seconds_1 = cycles(shared, baked, uv, distance, 0, folder)
        second, seconds_2 = cycles(shared, baked, uv, distance, 1, folder)
        error = difference(command, first, second, folder)[0] / math.sqrt(2)
        seconds = min(seconds_1, seconds_2)
        reference = os.path.join(folder, "reference.exr")
        os.replace(ours(command, scene, distance, folder, "--ao-samples", 32768, "--adaptive",
                        "off", "--seed", 9)[0], reference)
        for rays in RAYS:
            times = []
            for _ in range(3):
                path, time = ours(command, scene, distance, folder, "--ao-samples", rays)
                times.append(time)
            rmse, worst = difference(command, path, reference, folder)
            if rmse <= error:
                break
        time = sorted(times)[1]
        print(f"| {os.path.basename(scene)} | {error:.4f} | {seconds:.2f} | {rays} | {rmse:.4f} | "
              f"{worst:.3f} | {time:.3f} | {seconds / time:.0f} |", flush=True)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    command, shared = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    print("| scene | Cycles' error | its seconds | our rays | our error | largest | our seconds | times |")
    print("|---|---|---|---|---|---|---|---|")
    for name in sys.argv[3:] or SCENES:
        measure(command, shared, name)


main()
