#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Seconds to the same error as Blender's Cycles, on the same texels, in one run.

    scripts/peer_speed.py ALPENGLOW SHARED [SCENE ...]

SHARED is the folder with peers/blender/bake_peer.py. A scene without texture coordinates to bake
into is baked once by ours, and what it then has is its second set too, which both sides keep:
neither is charged for making charts. Cycles bakes those texels at 256 samples with two seeds (its
error is the difference over root two), and ours with more and more rays until its error, against
its own converged map, is no larger. Seconds, all in after loading: of Cycles the bake alone, of
ours atlas (checking the set and finding its texels), build and sampling. Seams are not stitched:
Cycles has no such step, and how far it moves texels at seams depends on stated errors, so that the
same texels of two bakes end up to .3 apart. Distance limit 0.2 of a metre or as given by
SCENE=DISTANCE, no fall-off. Needs Blender and numpy.

Then light: E/pi of the Cornell box after 8 bounces, at the error of Cycles' 256 samples; the errors
of both are the difference of two seeds over root two.
"""
import json
import math
import os
import struct
import subprocess
import sys
import tempfile

SCENES = ["{shared}/peers/blender/cornell.glb", "{shared}/peers/blender/sphere_plane.glb",
          "builtin:torus-plane=0.5", "builtin:teapot-room=0.5"]
RAYS = [64, 80, 96, 112, 128, 160, 192, 224, 256, 288, 320, 384, 448, 512, 640, 768, 1024]
LIGHT_PATHS = [16, 32, 48, 64, 80, 96, 128, 192, 256]
SIZE = 256


def run(*words):
    subprocess.run([str(w) for w in words], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)


def keep_first_set(path):
    """Makes the first texture coordinates of a .glb the second ones too, which bakes can keep."""
    data = open(path, "rb").read()
    length = struct.unpack("<I", data[12:16])[0]
    tree = json.loads(data[20 : 20 + length])
    for mesh in tree["meshes"]:
        for primitive in mesh["primitives"]:
            primitive["attributes"]["TEXCOORD_1"] = primitive["attributes"]["TEXCOORD_0"]
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    with open(path, "wb") as file:
        file.write(data[:8] + struct.pack("<III", 20 + len(text) + len(rest), len(text), 0x4E4F534A))
        file.write(text + rest)


def ours(command, scene, distance, folder, *options):
    maps = os.path.join(folder, "maps")
    run(command, "bake", scene, "--maps-dir", maps, "--size", SIZE, "--ao-distance", distance,
        "--ao-falloff", "none", "--atlas", "keep", "--stitch", "off", "--json",
        folder + "/ours.json", "-f", "-q", *options)
    seconds = json.load(open(folder + "/ours.json"))["seconds"]
    return maps + "/ao.exr", seconds["atlas"] + seconds["build"] + seconds["bake"]


def difference(command, a, b, folder):
    run(command, "compare", a, b, "--json", folder + "/difference.json", "-f", "-q")
    found = json.load(open(folder + "/difference.json"))
    return found["rmse"], found["maximum"]


def cycles(shared, scene, uv, seed, folder, *options):
    out, report = f"{folder}/cycles{seed}.exr", f"{folder}/cycles.json"
    environment = dict(os.environ, PATH="/usr/bin:/bin")  # the Python that has numpy
    subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "3", "--python",
                    shared + "/peers/blender/bake_peer.py", "--", "--scene", scene, "--size",
                    str(SIZE), "--samples", "256", "--seed", str(seed), "--uv", f"TEXCOORD_{uv}",
                    "--out", out, "--json", report, *options],
                   check=True, env=environment, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    return out, json.load(open(report))["seconds"]


def measure(command, shared, name):
    scene, _, distance = name.partition("=")
    scene, distance = scene.format(shared=shared), distance or "0.2"
    with tempfile.TemporaryDirectory() as folder:
        baked = scene
        if not scene.endswith(".glb"):
            baked = folder + "/scene.glb"
            run(command, "bake", scene, "-o", baked, "--size", SIZE, "--ao-samples", 4, "-q")
            keep_first_set(baked)
        ao = ("--type", "ao", "--ao-distance", distance)
        first, seconds_1 = cycles(shared, baked, 1, 0, folder, *ao)
        second, seconds_2 = cycles(shared, baked, 1, 1, folder, *ao)
        error = difference(command, first, second, folder)[0] / math.sqrt(2)
        seconds = min(seconds_1, seconds_2)
        reference = os.path.join(folder, "reference.exr")
        os.replace(ours(command, baked, distance, folder, "--ao-samples", 32768, "--adaptive",
                        "off", "--seed", 9)[0], reference)
        for rays in RAYS:
            times = []
            for _ in range(3):
                path, time = ours(command, baked, distance, folder, "--ao-samples", rays)
                times.append(time)
            rmse, worst = difference(command, path, reference, folder)
            if rmse <= error:
                break
        time = sorted(times)[1]
        print(f"| {os.path.basename(scene)} | {error:.4f} | {seconds:.2f} | {rays} | {rmse:.4f} | "
              f"{worst:.3f} | {time:.3f} | {seconds / time:.0f} |", flush=True)


def our_light(command, scene, folder, paths, seed):
    maps = f"{folder}/light{seed}"
    run(command, "bake", scene, "--maps", "light", "--maps-dir", maps, "--size", SIZE, "--atlas",
        "keep", "--stitch", "off", "--bounces", 8, "--samples", paths, "--seed", seed, "--json",
        folder + "/ours.json", "-f", "-q")
    seconds = json.load(open(folder + "/ours.json"))["seconds"]
    return maps + "/irradiance.exr", seconds["atlas"] + seconds["build"] + seconds["bake"]


def measure_light(command, shared):
    scene, light = shared + "/peers/blender/cornell.glb", ("--type", "diffuse", "--bounces", "8")
    with tempfile.TemporaryDirectory() as folder:
        first, seconds_1 = cycles(shared, scene, 1, 0, folder, *light)
        second, seconds_2 = cycles(shared, scene, 1, 1, folder, *light)
        error = difference(command, first, second, folder)[0] / math.sqrt(2)
        seconds = min(seconds_1, seconds_2)
        for paths in LIGHT_PATHS:
            maps, times = zip(*(our_light(command, scene, folder, paths, seed) for seed in range(3)))
            rmse, worst = difference(command, maps[0], maps[1], folder)
            rmse /= math.pi * math.sqrt(2)
            if rmse <= error:
                break
        time = sorted(times)[1]
        print(f"| cornell.glb, light | {error:.4f} | {seconds:.2f} | {paths} | {rmse:.4f} | "
              f"{worst / math.pi:.3f} | {time:.3f} | {seconds / time:.0f} |", flush=True)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    command, shared = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    print("| scene | Cycles' error | its seconds | our rays | our error | largest | our seconds | times |")
    print("|---|---|---|---|---|---|---|---|")
    for name in sys.argv[3:] or SCENES:
        measure(command, shared, name)
    if len(sys.argv) == 3:
        measure_light(command, shared)


main()
