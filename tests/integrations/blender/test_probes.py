# SPDX-License-Identifier: MIT
"""Probes: a file beside the .blend, and an object that shows their places."""

import json
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()


def test_probes():
    settings = support.empty_scene()
    settings.what, settings.spacing = "PROBES", 1.0
    support.add_mesh("plane", "floor", size=4, location=(0, 5, 0))
    support.add_mesh("cube", "tower", size=1, location=(1, 6, 2.5))
    support.set_world((0.5, 0.5, 0.5))
    try:
        bpy.ops.alpenglow.bake()
        raise AssertionError("probes of a file without a name")
    except RuntimeError as error:
        assert "save the .blend first" in str(error), error
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(support.FOLDER, "Räume.blend"))
    bpy.context.scene.alpenglow.what = "PROBES"
    message, _ = support.bake()
    path = os.path.join(support.FOLDER, "Räume.probes.json")
    assert path in message and os.path.exists(path[:-5] + ".ktx2"), message
    with open(path, encoding="utf-8") as file:
        description = json.load(file)
    shown = bpy.data.objects[addon.probes.NAME]
    assert len(shown.data.vertices) == description["count"] and not shown.data.polygons
    assert shown["file"] == "//Räume.probes.json" and list(shown["size"]) == description["size"]
    places = [v.co for v in shown.data.vertices]
    assert all(abs(p.x) <= 2 and 3 <= p.y <= 7 for p in places), "probes outside the scene"
    heights = sorted({round(v.co.z, 4) for v in shown.data.vertices})
    assert 0 <= heights[0] and heights[-1] <= 3 and len(heights) == description["size"][1], heights
    assert "Alpenglow" not in bpy.data.objects["floor"].data.uv_layers
    count = len(bpy.data.objects)
    support.bake()  # again: one object, one file
    assert len(bpy.data.objects) == count


def test_file_of_user():
    """A file that no bake of probes wrote stays. test_probes ran before."""
    path = os.path.join(support.FOLDER, "Räume.probes.json")
    for text in ('{"format": "other"}', "[]", "not JSON"):
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        try:
            bpy.ops.alpenglow.bake()
            raise AssertionError("a file of the user was overwritten")
        except RuntimeError as error:
            assert f"{path}: is not from a bake of probes" in str(error), error
        with open(path, encoding="utf-8") as file:
            assert file.read() == text
    os.remove(path)  # the textures alone
    try:
        bpy.ops.alpenglow.bake()
        raise AssertionError("a texture of the user was overwritten")
    except RuntimeError as error:
        assert "Räume.probes.ktx2: is not from a bake of probes" in str(error), error


support.main(test_probes, test_file_of_user)
