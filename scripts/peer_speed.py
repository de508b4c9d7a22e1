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

Then light: E/pi after 8 bounces, at the error of Cycles' 256 samples; the errors of both are the
difference of two seeds over root two, and ours has the same options in all scenes, with --error
falling until the error it has, over seeds too, is no larger. Scenes are asked for by light:NAME
(light: all of them): the Cornell box, the sphere on a plane under an even sky, the teapot room with
its own lamp, and living_room under a picture of the sky. Where the means of both are more than 3
percent apart, or ours does not reach the error, no ratio is given. "Apart" is what is left of the
difference between both when their noise is taken off, over the mean: ours is the mean over a
texel's area, Cycles' that at its middle, which may lie under a rug; surfaces seen from behind are
black in ours and reflect in Cycles; and what interpolation misses is in it too. Materials are
Lambert's in both, no denoiser on either side. Triangles without area are dropped before: with them
Blender's normals are wrong (living_room). Processor seconds, which tell more on a busy machine, are
of Cycles the bake alone and of ours the whole command, with reading and writing.
"""
import json
import math
import os
import resource
import struct
import subprocess
import sys
import tempfile

SCENES = ["{shared}/peers/blender/cornell.glb", "{shared}/peers/blender/sphere_plane.glb",
          "builtin:torus-plane=0.5", "builtin:teapot-room=0.5", "boxes:400=0.5"]
RAYS = [*range(64, 160, 8), *range(160, 320, 16), *range(320, 640, 32), *range(640, 1025, 64)]
LIGHT_ERRORS = [8, 7, 6, 5, 4.5, 4, 3.5, 3, 2.5, 2, 1.75, 1.5, 1.25, 1, 0.9, 0.8, 0.7, 0.65, 0.6,
                0.55, 0.5, 0.4, 0.3]
SKY = "{shared}/scenes/hdr/spiaggia_di_mondello_1k.hdr"
# Scene, our options, Cycles', and what scripts/bake_light_blender.py gives it besides: a picture of
# the sky, whose middle is at +X there and at -Z in ours, or "none": emission from the front alone.
LIGHTS = {
    "cornell": ("{shared}/peers/blender/cornell.glb", (), (), None),
    "sphere_plane": ("{shared}/peers/blender/sphere_plane.glb", ("--sky", "1,1,1"),
                     ("--world", "1"), None),
    "teapot-room": ("builtin:teapot-room", (), (), "none"),  # its lamp hangs under the ceiling
    "living_room": ("{shared}/scenes/architecture/living_room.glb",
                    ("--sky", SKY, "--sky-turn", "-90"), (), SKY),
}
SIZE = 256
SIZE_OF_BOXES = 512


def run(*words):
    subprocess.run([str(w) for w in words], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)


def read_glb(path):
    """The tree of a .glb, and the bytes of its buffer."""
    data = open(path, "rb").read()
    length = struct.unpack("<I", data[12:16])[0]
    return json.loads(data[20 : 20 + length]), bytearray(data[28 + length :])


def write_glb(path, tree, buffer):
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(buffer)))
        file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", len(buffer), 0x004E4942) + buffer)


def primitives(tree):
    return [p for mesh in tree["meshes"] for p in mesh["primitives"]]


def has_second_set(path):
    return all("TEXCOORD_1" in p["attributes"] for p in primitives(read_glb(path)[0]))


def keep_first_set(path):
    """Makes the only texture coordinates of a .glb the second ones too, which bakes can keep."""
    tree, buffer = read_glb(path)
    for primitive in primitives(tree):
        attributes = primitive["attributes"]
        attributes.setdefault("TEXCOORD_1", attributes["TEXCOORD_0"])
    write_glb(path, tree, buffer)


def is_flat(corners):
    a, b, c = corners
    u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
    normal = [u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2] for k in range(3)]
    return sum(x * x for x in normal) < 1e-16


def drop_flat(path, out):
    """Writes a .glb again without triangles that have no area."""
    tree, buffer = read_glb(path)

    def place(accessor):
        view = tree["bufferViews"][accessor["bufferView"]]
        return view.get("byteOffset", 0) + accessor.get("byteOffset", 0), view.get("byteStride", 12)

    for primitive in primitives(tree):
        accessor = tree["accessors"][primitive["indices"]]
        kind = {5121: "B", 5123: "H", 5125: "I"}[accessor["componentType"]]
        at, _ = place(accessor)
        first, step = place(tree["accessors"][primitive["attributes"]["POSITION"]])
        indices = struct.unpack_from(f"<{accessor['count']}{kind}", buffer, at)
        kept = []
        for k in range(0, len(indices), 3):
            triangle = indices[k : k + 3]
            if not is_flat([struct.unpack_from("<3f", buffer, first + step * i) for i in triangle]):
                kept.extend(triangle)
        struct.pack_into(f"<{len(kept)}{kind}", buffer, at, *kept)
        accessor["count"] = len(kept)
    write_glb(out, tree, buffer)


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
    write_glb(path, tree, points)


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


def blender(script, *words):
    environment = dict(os.environ, PATH="/usr/bin:/bin")  # the Python that has numpy
    subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "3", "--python",
                    script, "--", *(str(w) for w in words)], check=True, env=environment,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def our_script(name):
    return os.path.join(os.path.dirname(os.path.abspath(__file__)), name)


def cycles(shared, scene, size, uv, seed, folder, *options, sky=None):
    out, report = f"{folder}/cycles{seed}.exr", f"{folder}/cycles.json"
    script, before = shared + "/peers/blender/bake_peer.py", ()
    if sky is not None:
        script, before = our_script("bake_light_blender.py"), (script, sky)
    blender(script, *before, "--scene", scene, "--size", size, "--samples", 256, "--seed", seed,
            "--uv", f"TEXCOORD_{uv}", "--out", out, "--json", report, *options)
    found = json.load(open(report))
    return out, found["seconds"], min(found["cpu_seconds_all"])


def cycles_of_objects(scene, size, distance, folder):
    """Seconds of Cycles for all objects of a scene, not joined, in one call."""
    report = f"{folder}/objects.json"
    blender(our_script("bake_objects_blender.py"), scene, size, 256, distance, report)
    return json.load(open(report))["seconds"]


def give_charts(command, scene, size, folder):
    """The scene with texture coordinates that both sides keep."""
    if scene.startswith("boxes:"):
        write_boxes(int(scene[6:]), folder + "/boxes.glb")
        scene = folder + "/boxes.glb"
    elif scene.endswith(".glb"):
        if has_second_set(scene):
            return scene
        drop_flat(scene, folder + "/clean.glb")
        scene = folder + "/clean.glb"
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
        first, seconds_1, _ = cycles(shared, baked, size, 1, 0, folder, *ao)
        second, seconds_2, _ = cycles(shared, baked, size, 1, 1, folder, *ao)
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


def processor_seconds():
    """Of all children so far."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def our_light(command, scene, folder, wanted, seed, options):
    maps, before = f"{folder}/light{seed}", processor_seconds()
    run(command, "bake", scene, "--maps", "light", "--maps-dir", maps, "--size", SIZE, "--atlas",
        "keep", "--stitch", "off", "--bounces", 8, "--error", wanted, "--seed", seed, "--json",
        folder + "/ours.json", "-f", "-q", *options)
    processor = processor_seconds() - before
    seconds = json.load(open(folder + "/ours.json"))["seconds"]
    whole = seconds["atlas"] + seconds["build"] + seconds["bake"]
    return maps + "/irradiance.exr", whole, processor


def between(command, light, theirs, folder):
    """Root mean square of the difference of our E/pi and theirs, and the means of both."""
    run(command, "compare", light, theirs, "--scale", 1.0 / math.pi, "--json",
        folder + "/difference.json", "-f", "-q")
    found = json.load(open(folder + "/difference.json"))
    return found["rmse"], found["mean_a"], found["mean_b"]


def measure_light(command, shared, name):
    scene, our_options, options, sky = LIGHTS[name]
    our_options = [o.format(shared=shared) for o in our_options]
    sky = sky and sky.format(shared=shared)
    with tempfile.TemporaryDirectory() as folder:
        scene = give_charts(command, scene.format(shared=shared), SIZE, folder)
        (first, *times_1), (second, *times_2) = (
            cycles(shared, scene, SIZE, 1, seed, folder, "--type", "diffuse", "--bounces", "8",
                   *options, sky=sky) for seed in range(2))
        error = difference(command, first, second, folder)[0] / math.sqrt(2)
        seconds, processor = (min(t) for t in zip(times_1, times_2))
        for wanted in LIGHT_ERRORS:
            maps, times, used = zip(*(our_light(command, scene, folder, wanted, seed, our_options)
                                for seed in range(3)))
            rmse = difference(command, maps[0], maps[1], folder)[0] / (math.pi * math.sqrt(2))
            if rmse <= error:
                break
        ours = [sorted(times)[1], sorted(used)[1]]
        both, mean, their_mean = between(command, maps[0], first, folder)
        apart = math.sqrt(max(both**2 - rmse**2 - error**2, 0.0)) / their_mean
        good = abs(mean / their_mean - 1.0) <= 0.03 and rmse <= error
        ratios = [f"{theirs / our:.0f}" if good else "none"
                  for theirs, our in zip((seconds, processor), ours)]
        print(f"| {name} | {error:.4f} | {error / their_mean:.2%} | {wanted} % | {rmse:.4f} | "
              f"{seconds:.2f} | {ours[0]:.3f} | {ratios[0]} | {processor:.2f} | {ours[1]:.2f} | "
              f"{ratios[1]} | {mean / their_mean - 1.0:+.2%} | {apart:.2%} |", flush=True)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    command, shared = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    names = sys.argv[3:] or [*SCENES, "light:"]
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.2f} before\n")
    lights = [n[6:] for n in names if n.startswith("light:")]
    scenes = [n for n in names if not n.startswith("light:")]
    unknown = [n for n in lights if n and n not in LIGHTS]
    if unknown:
        sys.exit(f"no light:{unknown[0]}; there are {', '.join('light:' + n for n in LIGHTS)}")
    if scenes:
        print("| scene | Cycles' error | its seconds | our rays | our error | largest | "
              "our seconds | times |")
        print("|---|---|---|---|---|---|---|---|")
    for name in scenes:
        measure(command, shared, name)
    if lights:
        print("| light | Cycles' error | over the mean | our --error | our error | its seconds | "
              "ours | times | its processor seconds | ours | times | our mean, against its | "
              "apart |")
        print("|---|---|---|---|---|---|---|---|---|---|---|---|---|", flush=True)
    for name in LIGHTS if "" in lights else lights:
        measure_light(command, shared, name)


main()
