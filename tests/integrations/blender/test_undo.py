# SPDX-License-Identifier: MIT
"""One step of undo returns to the scene before the bake, and one of redo to the bake.

Without a window no key is pressed: the operator runs with its undo flag, as the button runs it, and
ed.undo takes the step back. test_window.py tests a modal run, which needs a window."""

import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()


def scene():
    settings = support.empty_scene()
    settings.what = "BOTH"
    shared = support.add_material("m", (0.8, 0.2, 0.2))
    support.add_mesh("monkey", "monkey", shared).modifiers.new("more", "SUBSURF")
    cube = support.add_mesh("cube", "cube", shared, location=(3, 0, 0))
    twin = bpy.data.objects.new("twin", cube.data)
    twin.location = (-3, 0, 0)
    bpy.context.scene.collection.objects.link(twin)
    support.add_mesh("plane", "floor", size=9, location=(0, 0, -1))
    support.add_lamp("POINT", "lamp", 100, (2, 0, 3))


def test_one_step():
    scene()
    bpy.ops.ed.undo_push(message="before")
    before = support.state_of_scene()
    assert bpy.ops.alpenglow.bake("EXEC_DEFAULT", True) == {"FINISHED"}
    after = support.state_of_scene()
    assert after != before and "monkey.baked" in bpy.data.objects
    assert bpy.ops.ed.undo() == {"FINISHED"}
    support.check_state(before)
    assert bpy.data.objects["cube"].data == bpy.data.objects["twin"].data
    assert bpy.data.objects["monkey"].visible_get()
    assert bpy.ops.ed.redo() == {"FINISHED"}
    support.check_state(after)
    images = [i for i in bpy.data.images if i.get("alpenglow")]
    assert len(images) == 2 and all(i.packed_file is not None for i in images)


def test_saved_file():
    """The result lives in the .blend: maps, groups and UV map come back with it."""
    scene()
    support.bake()
    state = support.state_of_scene()
    path = os.path.join(support.FOLDER, "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    support.check_state(state)
    light = next(i for i in bpy.data.images if i.get("alpenglow") == "light")
    assert max(light.pixels[:]) > 0.1 and light.packed_file is not None


support.main(test_one_step, test_saved_file)
