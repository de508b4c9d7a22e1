# SPDX-License-Identifier: MIT
"""Remove Bake takes a saved bake back, and one step of undo returns to the bake."""

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
    support.add_mesh("cube", "grown", shared, size=1).modifiers.new("more", "SUBSURF")
    support.add_mesh("cube", "cube", shared, location=(3, 0, 0))
    support.add_mesh("cube", "bare", location=(-3, 0, 0))
    plain = bpy.data.materials.new("plain")
    support.add_mesh("plane", "floor", plain, size=9, location=(0, 0, -1))
    group = bpy.data.collections.new("group")
    lamp = support.add_lamp("POINT", "lamp", 100, (2, 0, 3))
    for o in (lamp, support.add_mesh("cube", "inner", shared, size=1)):
        bpy.context.scene.collection.objects.unlink(o)
        group.objects.link(o)
    copy = bpy.data.objects.new("copy", None)
    copy.instance_type, copy.instance_collection, copy.location = "COLLECTION", group, (0, 3, 0)
    bpy.context.scene.collection.objects.link(copy)


def test_removal():
    scene()
    before = support.state_of_scene()
    assert bpy.ops.alpenglow.remove() == {"CANCELLED"}, "a bake of a scene without one"
    support.check_state(before)
    support.bake()
    support.bake()  # a second one changes nothing about the first state
    path = os.path.join(support.FOLDER, "baked.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    bpy.ops.ed.undo_push(message="loaded")
    baked = support.state_of_scene()
    assert {"grown.baked", "copy/inner.baked", "copy/lamp.baked"} <= set(bpy.data.objects.keys())
    assert bpy.ops.alpenglow.remove("EXEC_DEFAULT", True) == {"FINISHED"}
    support.check_state(before)
    assert bpy.ops.ed.undo() == {"FINISHED"}
    support.check_state(baked)


def test_after_changes():
    """Originals and copies that the user removed, and settings of the panel."""
    scene()
    before = support.state_of_scene()
    support.bake()
    bpy.data.objects.remove(bpy.data.objects["grown.baked"])
    bpy.data.objects.remove(bpy.data.objects["copy"])
    assert bpy.ops.alpenglow.remove() == {"FINISHED"}
    assert not [o for o in bpy.data.objects if o.name.endswith(".baked")]
    assert bpy.data.objects["grown"].visible_get() and not bpy.data.objects["grown"].hide_render
    lines = {line for line in before if not line.startswith("object ('copy'")}
    support.check_state(sorted(lines))


support.main(test_removal, test_after_changes)
