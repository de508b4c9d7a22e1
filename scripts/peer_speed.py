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

boxes:N is N boxes, each an object of its own, in one atlas of 512 x 512. The peer's script joins
them to one mesh, which Cycles bakes faster; a second row is Cycles' seconds for what a user has,
all objects selected and baked in one call, at the same error.

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
          "builtin:torus-plane=0.5", "builtin:teapot-room=0.5", "boxes:400=0.5"]
RAYS = [*range(64, 160, 8), *range(160, 320, 16), *range(320, 640, 32), *range(640, 1025, 64)]
LIGHT_PATHS = [16, 32, 48, 64, 80, 96, 128, 192, 256]
SIZE = 256
SIZE_OF_BOXES = 512


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


def write_boxes(count, path):
    """A .glb of boxes on a square grid of a metre, turned and of other sizes by their number."""
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    points = b"".join(struct.pack("<3f", *corners[i]) for t in triangles for i in t)
    side = math.ceil(math.sqrt(count))
    nodes = []
    for i in range(count):
        size = [0.3 + 0.35 * (i * k % 17) / 16 for k in (3, 5, 7)]
        turn = math.pi / 4 * (i * 11 % 13) / 12
        nodes.append({"name": f"box {i}", "mesh": i, "scale": size,
                      "rotation": [0, math.sin(turn / 2), 0, math.cos(turn / 2)],
                      "translation": [i % side, 0, i // side]})
    tree = {"asset": {"version": "2.0"}, "scenes": [{"nodes": list(range(count))}], "scene": 0,
            "nodes": nodes, "buffers": [{"byteLength": len(points)}],
            "bufferViews": [{"buffer": 0, "byteLength": len(points)}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 36,
                           "min": [0, 0, 0], "max": [1, 1, 1]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]} for _ in range(count)]}
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(points)))
        file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", len(points), 0x004E4942) + points)


def ours(command, scene, size, distance, folder, *options):
    maps = os.path.join(folder, "maps")
    run(command, "bake", scene, "--maps-dir", maps, "--size", size, "--ao-distance", distance,
        "--ao-falloff", "none", "--atlas", "keep", "--stitch", "off", "--json",
        folder + "/ours.json", "-f", "-q", *options)
    seconds = json.load(open(folder + "/ours.json"))["seconds"]
    return maps + "/ao.exr", seconds["atlas"] + seconds["build"] + seconds["bake"]


def difference(command, a, b, folder):
    run(command, "compare", a, b, "--json", folder + "/difference.json", "-f", "-q")
    found = json.load(open(folder + "/difference.json"))
    return found["rmse"], found["maximum"]


def cycles(shared, scene, size, uv, seed, folder, *options):
    out, report = f"{folder}/cycles{seed}.exr", f"{folder}/cycles.json"
    environment = dict(os.environ, PATH="/usr/bin:/bin")  # the Python that has numpy
    subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "3", "--python",
                    shared + "/peers/blender/bake_peer.py", "--", "--scene", scene, "--size",
                    str(size), "--samples", "256", "--seed", str(seed), "--uv", f"TEXCOORD_{uv}",
                    "--out", out, "--json", report, *options],
                   check=True, env=environment, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    return out, json.load(open(report))["seconds"]


def cycles_of_objects(scene, size, distance, folder):
    """Seconds of Cycles for all objects of a scene, not joined, in one call."""
    report = f"{folder}/objects.json"
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bake_objects_blender.py")
    environment = dict(os.environ, PATH="/usr/bin:/bin")
    subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "3", "--python",
                    script, "--", scene, str(size), "256", distance, report], check=True,
                   env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return json.load(open(report))["seconds"]


def give_charts(command, scene, size, folder):
    """The scene with texture coordinates that both sides keep."""
    if scene.startswith("boxes:"):
        write_boxes(int(scene[6:]), folder + "/boxes.glb")
        scene = folder + "/boxes.glb"
    if scene.endswith(".glb") and not scene.startswith(folder):
        return scene
    run(command, "bake", scene, "-o", folder + "/scene.glb", "--size", size, "--ao-samples", 4,
        "-q")
    keep_first_set(folder + "/scene.glb")
    return folder + "/scene.glb"


def measure(command, shared, name):
    scene, _, distance = name.partition("=")
    scene, distance = scene.format(shared=shared), distance or "0.2"
    boxes = scene.startswith("boxes:")
    size = SIZE_OF_BOXES if boxes else SIZE
    with tempfile.TemporaryDirectory() as folder:
        baked = give_charts(command, scene, size, folder)
        ao = ("--type", "ao", "--ao-distance", distance)
        first, seconds_1 = cycles(shared, baked, size, 1, 0, folder, *ao)
        second, seconds_2 = cycles(shared, baked, size, 1, 1, folder, *ao)
        error = difference(command, first, second, folder)[0] / math.sqrt(2)
        seconds = [(os.path.basename(scene), min(seconds_1, seconds_2))]
        if boxes:
            seconds.append((f"{scene}, not joined", cycles_of_objects(baked, size, distance, folder)))
        reference = os.path.join(folder, "reference.exr")
        os.replace(ours(command, baked, size, distance, folder, "--ao-samples", 32768,
                        "--adaptive", "off", "--seed", 9)[0], reference)
        for rays in RAYS:
            times = []
            for _ in range(3):
                path, time = ours(command, baked, size, distance, folder, "--ao-samples", rays)
                times.append(time)
            rmse, worst = difference(command, path, reference, folder)
            if rmse <= error:
                break
        time = sorted(times)[1]
        for row, theirs in seconds:
            print(f"| {row} | {error:.4f} | {theirs:.2f} | {rays} | {rmse:.4f} | {worst:.3f} | "
                  f"{time:.3f} | {theirs / time:.0f} |", flush=True)


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
        first, seconds_1 = cycles(shared, scene, SIZE, 1, 0, folder, *light)
        second, seconds_2 = cycles(shared, scene, SIZE, 1, 1, folder, *light)
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
