# SPDX-License-Identifier: MIT
"""Objects that cannot take part in a bake, or cannot take the map: they stay as they are, and a
note says why."""

import math
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()


def far():
    support.add_mesh("cube", "odd").location.x = 1e20


def flat():
    support.add_mesh("cube", "odd", location=(0, 0, 1)).scale = (0, 0, 1)


def line():
    support.add_mesh("plane", "odd", location=(0, 0, 1)).scale.x = 0


def broken():
    support.add_mesh("cube", "odd", location=(0, 0, 1)).data.vertices[3].co.y = math.nan


def turned():
    support.add_mesh("cube", "odd", location=(0, 0, 1)).matrix_world[1][1] = math.inf


FAULTS = {far: "odd is more than 1e15 m away: it is left out", flat: "odd has no area: it is left",
          line: "odd has no area: it is left out of the bake; check its scale",
          broken: "odd has a coordinate that is not a finite number: it is left out of the bake; "
                  "delete that vertex", turned: "odd has a coordinate that is not a finite number"}


def is_untouched(name):
    o = bpy.data.objects[name]
    return "Alpenglow" not in o.data.uv_layers and not o.data.materials and o.visible_get()


def test_left_out():
    for add, fault in FAULTS.items():
        support.floor_and_lamp()
        add()
        message, notes = support.bake()
        print(f"  {add.__name__}: {notes}")
        assert message.startswith("1 object is baked ("), message
        assert len(notes) == 1 and notes[0].startswith(fault), notes
        assert is_untouched("odd") and "Alpenglow" in bpy.data.objects["floor"].data.uv_layers


def test_nothing_left():
    """A scene whose objects are all left out names them."""
    support.empty_scene()
    flat()
    try:
        bpy.ops.alpenglow.bake()
        raise AssertionError("the bake ended well")
    except RuntimeError as error:
        assert "nothing to bake: odd has no area: it is left out" in str(error), error


def instanced(*inner):
    group = bpy.data.collections.new("group")
    for o in inner:
        bpy.context.scene.collection.objects.unlink(o)
        group.objects.link(o)
    shown = bpy.data.objects.new("inst", None)
    shown.instance_type, shown.instance_collection = "COLLECTION", group
    bpy.context.scene.collection.objects.link(shown)
    return shown


def test_instances():
    """An instance without area shows nothing. Another fault keeps the instancer."""
    for add in (flat, broken):
        support.floor_and_lamp()
        add()
        shown = instanced(support.add_mesh("cube", "good", location=(0, 0, 2)),
                          bpy.data.objects["odd"])
        _, notes = support.bake()
        assert any(n.startswith("inst/odd has ") for n in notes), notes
        assert shown.hide_render == (add is flat), notes
        assert any(n.startswith("inst stays as it is: odd has a coordinate") for n in notes) == \
            (add is broken), notes


def with_eight_maps(o):
    while len(o.data.uv_layers) < 8:
        o.data.uv_layers.new()
    return o


def test_eight_uv_maps():
    """A mesh without room for one more map gets no texels, and still shades."""
    for has_modifier in (False, True):
        settings = support.floor_and_lamp()
        settings.what = "OCCLUSION"
        full = with_eight_maps(support.add_mesh("cube", "full", location=(0, 0, 1)))
        if has_modifier:
            full.modifiers.new("more", "SUBSURF")
        exporter = addon.export.Exporter(bpy.context, False)
        exporter.write(os.path.join(support.FOLDER, "eight.glb"))
        assert exporter.has_kept_nodes() and exporter.notes == [
            "full has eight UV maps: it shades and reflects, and gets no map; remove one and bake "
            "again"], exporter.notes
        message, notes = support.bake()
        assert message.startswith("1 object is baked") and notes == exporter.notes, notes
        assert is_untouched("full") and "full.baked" not in bpy.data.objects
        values = bpy.data.images["Alpenglow occlusion"].pixels[:][0::4]
        assert min(values) < 0.5, "the cube shades nothing"


support.main(test_left_out, test_nothing_left, test_instances, test_eight_uv_maps)
