# SPDX-License-Identifier: MIT
"""Two rooms of the shared folder, loaded by Blender's importer: export, bake and apply with the
seconds of each, and the picture against the command's."""

import os
import sys
import time

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

SCENES = os.path.join(os.environ["ALPENGLOW_SHARED"], "scenes", "architecture")
numpy.bool = bool  # Blender 3.4's importer of glTF needs a name that numpy 1.24 lacks

if not os.path.isdir(SCENES):
    print(f"{SCENES} is absent: skipped (set ALPENGLOW_SHARED)", flush=True)
    os._exit(77)
addon = support.install()


def load(name):
    settings = support.empty_scene()
    settings.size = 512
    bpy.ops.import_scene.gltf(filepath=os.path.join(SCENES, name))
    support.set_world((1, 1, 1))
    return settings


def frame():
    """A camera in the middle of the scene, which sees one half of it."""
    corners = numpy.array([o.matrix_world @ v.co for o in bpy.context.scene.objects
                           if o.type == "MESH" for v in o.data.vertices])
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = (low + high) / 2
    camera = support.add_camera(tuple(middle), tuple(low))
    camera.data.angle = 1.4
    camera.data.clip_start = 0.01


def round_trip(name):
    load(name)
    frame()
    shown = [o for o in bpy.context.scene.objects if o.type == "MESH"]
    triangles = sum(len(p.vertices) - 2 for o in shown for p in o.data.polygons)
    began = time.monotonic()
    message, notes = support.bake()
    print(f"{name}: {len(shown)} objects, {triangles} triangles; {message}; in all "
          f"{time.monotonic() - began:.1f} s; {notes}")
    assert all("Alpenglow" in o.data.uv_layers for o in shown if len(o.data.polygons))
    baked, _ = support.bake_in(support.FOLDER)  # again, to keep the files of the command
    ours, cycles = support.render_command(baked, "--sky", "1,1,1"), support.render_cycles()
    share = support.close_share(ours, cycles)
    white, black = support.unseen_shares(cycles)
    print(f"{name}: {100 * share:.2f} % of pixels within 1/255, mean {cycles.mean():.4f} (the "
          f"command {ours.mean():.4f}), {100 * white:.1f} % white, {100 * black:.1f} % black")
    assert share >= 0.99 and support.close(ours.mean(), cycles.mean(), 0.005)
    assert white <= 0.06 and black <= 0.01  # at most 1 % is above white; the sky is as bright
    assert not any("normals are zero" in note for note in notes), notes
    return cycles.mean()


def test_living_room():
    mean = round_trip("living_room.glb")
    assert 0.2 < mean < 0.4, mean


def test_zdm2():
    mean = round_trip("zdm2.glb")
    assert 0.15 < mean < 0.35, mean


if __name__ == "__main__":
    support.main(test_living_room, test_zdm2)
