# SPDX-License-Identifier: MIT
"""The fate of objects, and the meshes and materials of the written .glb."""

import os
import subprocess
import sys

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()
SCENE = os.path.join(support.FOLDER, "scene.glb")


def export():
    """(document, exporter) of what is visible, as a .glb in SCENE."""
    exporter = addon.export.Exporter(bpy.context, False)
    exporter.write(SCENE)
    return exporter.writer.document, exporter


def fates():
    return {item.name: item.fate for item in export()[1].items}


def add_cube(name, modifier=None):
    shown = support.add_mesh("cube", name)
    return shown if modifier is None else shown.modifiers.new("modifier", modifier)


def test_fates():
    """Objects with data of faces come back as copies, so that no cut spoils them."""
    support.empty_scene()
    expected = {"plain": "own", "bent": "own", "target": "baked"}
    add_cube("plain")
    add_cube("bent", "SIMPLE_DEFORM")
    add_cube("target")
    for kind in ("MULTIRES", "MESH_DEFORM", "LAPLACIANDEFORM", "CORRECTIVE_SMOOTH", "CLOTH",
                 "SOFT_BODY", "MESH_SEQUENCE_CACHE", "PARTICLE_SYSTEM"):
        add_cube(kind, kind)
        expected[kind] = "baked"
    add_cube("SURFACE_DEFORM", "SURFACE_DEFORM").target = bpy.data.objects["target"]
    expected["SURFACE_DEFORM"] = "baked"
    found = fates()
    assert found == expected, found


def test_background():
    """A background scene shades and reflects, and shines; only this view layer takes the map."""
    settings = support.empty_scene()
    settings.what = "BOTH"
    front = support.add_mesh("plane", "front", size=2)
    behind = bpy.data.scenes.new("behind")
    roof = bpy.data.objects.new("roof", front.data.copy())
    roof.location = (0, 0, 0.1)
    lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT"))
    lamp.location = (0, 0, 0.05)
    for o in (roof, lamp):
        behind.collection.objects.link(o)
    bpy.context.scene.background_set = behind
    try:
        assert fates() == {"front": "own", "roof": "kept"}, fates()
        _, notes = support.bake()
        assert any(n.startswith("roof is in a background scene: it shades") for n in notes), notes
        assert addon.nodes.UV_MAP in front.data.uv_layers
        assert addon.nodes.UV_MAP not in roof.data.uv_layers and not roof.hide_render
        image = next(i for i in bpy.data.images if i.get("alpenglow") == "occlusion")
        values = numpy.array(image.pixels[:]).reshape(-1, 4)[:, 0]
        assert values.mean() < 0.6, values.mean()  # the roof hides most of the sky
    finally:
        bpy.context.scene.background_set = None
        bpy.data.scenes.remove(behind)


def warnings_of(path):
    ran = subprocess.run(["alpenglow", "info", path], capture_output=True, text=True, check=True)
    return [line for line in (ran.stdout + ran.stderr).splitlines() if "normals are zero" in line]


def test_normals():
    """A smooth polygon without area gets a normal also if its own, a custom one, is lost."""
    support.empty_scene()
    mesh = bpy.data.meshes.new("mesh")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 0, 0)], [], [(0, 1, 2), (0, 1, 3)])
    line = bpy.data.meshes.new("line")
    line.from_pydata([(0, 0, 3), (0, 0, 4), (0, 0, 6)], [], [(0, 1, 2)])
    for data in (mesh, line):
        for polygon in data.polygons:
            polygon.use_smooth = True
        if hasattr(data, "use_auto_smooth"):  # until Blender 4.0
            data.use_auto_smooth = True
        data.normals_split_custom_set([(1, 0, 0)] * len(data.loops))
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(data.name, data))
        normals = addon.export.Loops(data).normals
        lengths = numpy.linalg.norm(normals, axis=1)
        assert numpy.allclose(lengths, 1, atol=1e-4), normals
    export()
    assert warnings_of(SCENE) == [], warnings_of(SCENE)


support.main(test_fates, test_background, test_normals)
