#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A table of all files of the shared scenes, and what became of each.

    every_scene.py COMMAND COUNT_TRIANGLES SHARED

Good ones load with the triangles that SOURCES.md counts, bake at 256 and read back with as many; a
baked glTF brings the Khronos validator no new error. Broken ones do what EXPECT.tsv says: what is
invalid is refused with exit code 1 and a message that names the file, and leaves nothing behind;
what is odd bakes and reads back, or says why there is nothing to bake. A sky lights a scene.
Exit status: 0 good, 1 not, 77 skipped, for SHARED (or $ALPENGLOW_SHARED) is absent.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SCENES = {".glb", ".gltf", ".dae", ".obj"}
SKIES = {".hdr", ".exr"}
# Odd files that hold nothing to bake, and in which words that is said.
NOTHING = {
    "collinear_triangles.glb": "no triangle has area",
    "degenerate_indices.glb": "no triangle has area",
    "empty_scene.gltf": "the scene has no triangles",
    "huge_coordinates_1e30.glb": r"beyond 1e\+15 m",
    "inf_vertices.glb": "not finite",
    "invalid-face-definition.obj": "no faces: there is nothing to bake",
    "lights.dae": "nothing to bake: the scene has no triangles",
    "nan.obj": '"nan" is no finite',
    "nan_vertices.glb": "not finite",
    "no_geometry.dae": "the scene has no triangles",
    "points_only.glb": "the scene has no triangles",
    "test-nan.obj": '"nan" is no finite',
    "zero_scale.glb": "they have no area",
    "zero_size_scene.glb": "they have no area",
}
# Odd files whose bake must warn, and of what.
WARNED = {
    "BoxBadNormals.glb": "normals are zero",
    "albedo_out_of_range.glb": "clamped",
    "corrupt_png.glb": "PNG: .*read without this texture",
    "far_from_origin_6378km.glb": "move it near the origin",
    "index_count_not_3n.glb": "make no triangle",
    "material_index_out_of_range.glb": "there are no materials",
    "missing_mtl.obj": "is not there",
    "spot_inner_gt_outer.glb": "cone angles",
    "zero_normals.glb": "normals are zero",
}
# Areas [m²] that EXPECT.tsv states.
AREAS = {"concave_ngon.obj": 3.0, "polygons_with_hole.dae": 8.0, "z_up_inches.dae": 0.254**2}
# SOURCES.md counts nodes; these are instances that EXT_mesh_gpu_instancing adds to one: 5³.
INSTANCES = {"SimpleInstancing.gltf": 125}
# EXPECT.tsv calls them invalid. The first carries its buffer in a data: URI; a reference to no
# material costs the reference alone.
SOUND = {"missing_external_bin.gltf", "material_index_out_of_range.glb"}
# Skies that the library we read EXR with cannot inflate; their .hdr copies stand beside them.
DWAB = {"interior.exr", "sunset.exr"}
# Third-party files that EXPECT.tsv does not speak of.
INVALID = {"RecursiveNodes.gltf", "IndexOutOfRange.gltf", "AllIndicesOutOfRange.gltf",
           "issue-140-zero-face-idx.obj"}


class Bench:
    """The command, a folder to write to, and the verdicts so far."""

    def __init__(self, command, counter, shared, folder):
        self.command, self.counter = command, counter
        self.scenes, self.folder = shared / "scenes", folder
        self.failed = 0
        validator = pathlib.Path(__file__).resolve().parent.parent / "validator"
        self.validate = validator / "validate.mjs"
        self.validates = (validator / "node_modules/gltf-validator").is_dir()

    def run(self, *arguments):
        """Exit code, and what was said on both streams."""
        done = subprocess.run([self.command, *map(str, arguments)], capture_output=True,
                              text=True, errors="replace", timeout=300, check=False)
        return done.returncode, done.stdout + done.stderr

    def fact(self, path, name):
        """A number that `info` tells, None where it does not."""
        code, said = self.run("info", path)
        found = re.search(rf"^{name} +(\S+)", said, re.M)
        return float(found[1]) if code == 0 and found else None

    def triangles(self, path):
        """What `info` states, after the doctor has examined the scene."""
        count = self.fact(path, "triangles")
        return None if count is None else int(count)

    def read_back(self, path):
        """Triangles of a file that we wrote; read by the library alone, which is faster."""
        done = subprocess.run([self.counter, path], capture_output=True, text=True, timeout=300,
                              check=False)
        return int(done.stdout) if done.returncode == 0 else None

    def bake(self, path, size):
        """Exit code, what was said, and the asset's path."""
        shutil.rmtree(self.folder)
        self.folder.mkdir()
        out = self.folder / ("out" + path.suffix.lower())
        code, said = self.run("bake", path, "-o", out, "--size", size, "--ao-samples", 4,
                              "--progress", "off")
        return code, said, out

    def tell(self, name, faults, *columns):
        self.failed += bool(faults)
        row = "".join(f"{c:>10}" for c in columns)
        print(f"{name:<58}{row}  {'; '.join(faults) if faults else 'ok'}", flush=True)


def counted(shared):
    """{file: triangles} of the tables in SOURCES.md."""
    counts, kind = {}, ""
    for line in (shared / "scenes/SOURCES.md").read_text().splitlines():
        kind = line[3:] if line.startswith("## ") else kind
        cells = [c.strip() for c in line.split("|")[1:-1]]
        if not cells or pathlib.Path(cells[0]).suffix.lower() not in SCENES:
            continue
        if kind.startswith("Scenes"):  # unique (shown); an OBJ has no instances
            shown = re.match(r"(\d+) \((\d+)\)", cells[1])
            count = int(shown[2] if shown else cells[1].split()[0])
            counts[cells[0]] = count * INSTANCES.get(cells[0].rsplit("/", 1)[-1], 1)
        elif kind == "COLLADA":
            counts[cells[0]] = int(re.search(r"(\d+)$", cells[5])[1])
    return counts


def test_good(bench, name, asked):
    path = bench.scenes / name
    found, faults = bench.triangles(path), []
    if path.name in NOTHING: # `info` tells what else is in it; there is nothing to bake
        return test_nothing(bench, path, name, asked)
    code, said, out = bench.bake(path, 256)
    after = bench.read_back(out) if code == 0 else None
    if found != asked:
        faults.append("not the triangles of SOURCES.md")
    if code != 0:
        faults.append(f"exit code {code}: {said.strip()}")
    elif after != found:
        faults.append("reads back with other triangles")
    elif bench.validates and out.suffix in (".glb", ".gltf"):
        done = subprocess.run(["node", bench.validate, path, out], capture_output=True, text=True,
                              check=False)
        if done.returncode != 0:
            faults.append("validator: " + done.stdout.strip())
    return bench.tell(name, faults, asked, found or "-", after or "-")


def test_nothing(bench, path, name, asked):
    code, said, _ = bench.bake(path, 256)
    faults = [] if code == 1 else [f"exit code {code}"]
    if not re.search(NOTHING[path.name], said):
        faults.append(f"does not say {NOTHING[path.name]}: {said.strip()}")
    if list(bench.folder.iterdir()):
        faults.append("leaves files behind")
    bench.tell(name, faults, asked, "nothing", "-")


def test_odd(bench, path, name):
    code, said, out = bench.bake(path, 32)
    after = bench.read_back(out) if code == 0 else None
    faults = [] if code == 0 else [f"exit code {code}: {said.strip()}"]
    if path.name in WARNED and not re.search(WARNED[path.name], said):
        faults.append(f"does not say {WARNED[path.name]}: {said.strip()}")
    if code == 0 and after != bench.triangles(path):
        faults.append("reads back with other triangles")
    if path.name in AREAS and abs(bench.fact(path, "area") / AREAS[path.name] - 1.0) > 1e-5:
        faults.append("the area is not that of EXPECT.tsv")
    bench.tell(name, faults, "odd", "baked", after or "-")


def test_invalid(bench, path, name, run):
    code, said = run
    faults = [] if code == 1 else [f"exit code {code}"]
    if path.name not in said:
        faults.append(f"the message names no file: {said.strip()}")
    if list(bench.folder.iterdir()):
        faults.append("leaves files behind")
    bench.tell(name, faults, "invalid", "refused", "-")


def light_by(bench, path):
    """Exit code and words of a picture under this sky."""
    shutil.rmtree(bench.folder)
    bench.folder.mkdir()
    return bench.run("render", "builtin:sphere-plane", "-o", bench.folder / "sky.png", "--with",
                     "reference", "--sky", path, "--resolution", "16x9", "--samples", 1, "-q")


def test_sky(bench, path, name):
    code, said = light_by(bench, path)
    if path.name in DWAB:
        clear = code == 1 and "DWAB compression is not supported; convert it to ZIP" in said
        bench.tell(name, [] if clear else [said], "sky", "refused", "-")
    else:
        bench.tell(name, [said] if code else [], "sky", "lights", "-")


def test_broken(bench, path, kinds):
    name = str(path.relative_to(bench.scenes))
    kind = kinds.get(path.name, "invalid" if path.name in INVALID else "odd")
    if path.name in NOTHING:
        test_nothing(bench, path, name, kind)
    elif path.suffix in SKIES:
        run = light_by(bench, path)
        if kind == "invalid":
            test_invalid(bench, path, name, run)
        else:
            bench.tell(name, [run[1]] if run[0] else [], kind, "lights", "-")
    elif kind == "invalid" and path.name not in SOUND:
        run = bench.bake(path, 32)
        test_invalid(bench, path, name, run[:2])
    else:
        test_odd(bench, path, name)


def test_all(bench, shared):
    counts = counted(shared)
    print(f"{'good':<58}{'asked':>10}{'found':>10}{'baked':>10}")
    for name in sorted(counts):
        test_good(bench, name, counts[name])
    files = sorted(p for p in bench.scenes.rglob("*") if p.is_file())
    known = [p for p in files if p.suffix.lower() in SCENES | SKIES]
    for path in known:
        name = str(path.relative_to(bench.scenes))
        if path.suffix in SKIES and not name.startswith("broken"):
            test_sky(bench, path, name)
        elif path.suffix.lower() in SCENES and not name.startswith(("broken", "reports")):
            if name not in counts:
                bench.tell(name, ["SOURCES.md does not count it"])
    table = (bench.scenes / "broken/crafted/EXPECT.tsv").read_text().splitlines()[1:]
    kinds = {row.split("\t")[0]: row.split("\t")[1] for row in table}
    print(f"\n{'broken':<58}{'is':>10}{'was':>10}{'baked':>10}")
    broken = [p for p in known if p.is_relative_to(bench.scenes / "broken")]
    for path in broken:
        test_broken(bench, path, kinds)
    for name in sorted(set(kinds) - {p.name for p in broken}):
        bench.tell(name, ["is in EXPECT.tsv, but not there"])


def main():
    shared = pathlib.Path(os.environ.get("ALPENGLOW_SHARED") or sys.argv[3])
    if not (shared / "scenes").is_dir():
        print(f"{shared}/scenes is absent: skipped (set ALPENGLOW_SHARED)")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        out.mkdir()
        bench = Bench(sys.argv[1], sys.argv[2], shared, out)
        test_all(bench, shared)
    if not bench.validates:
        print("not validated: gltf-validator is absent")
    print(f"{bench.failed} of the files failed")
    return 1 if bench.failed else 0


if __name__ == "__main__":
    sys.exit(main())
