# SPDX-License-Identifier: MIT
"""Materials whose node groups the user has deleted show what they showed before the bake."""

import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()


def baked_scene(has_texture=False):
    """Returns the state of the material before the bake."""
    settings = support.empty_scene()
    settings.what = "BOTH"
    material = support.add_material("red", (0.8, 0.1, 0.1))
    if has_texture:
        tree = material.node_tree
        colour = tree.nodes.new("ShaderNodeRGB")
        colour.outputs[0].default_value = (0.8, 0.1, 0.1, 1)
        tree.links.new(colour.outputs[0], tree.nodes["Principled BSDF"].inputs["Base Color"])
    support.add_mesh("plane", "floor", material, size=8)
    support.add_lamp("POINT", "lamp", 200, (2, -2, 4))
    before = support.state_of_scene()
    support.bake()
    return before


def delete_groups(*names):
    for name in names:
        bpy.data.node_groups.remove(bpy.data.node_groups[name])


def save_and_load():
    """Blender then drops the sockets of a node without its group."""
    path = os.path.join(support.FOLDER, "dead.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)


def groups_of(tree):
    return sorted((n.label, n.node_tree is None) for n in tree.nodes if n.type == "GROUP")


def test_bake_again():
    for has_texture in (False, True):
        for loads in (False, True):
            baked_scene(has_texture)
            delete_groups(addon.nodes.LIGHT, addon.nodes.OCCLUSION)
            if loads:
                save_and_load()
            _, notes = support.bake()
            assert "material red: the node group Alpenglow Light was deleted; the links are as " \
                "before" in notes and len(notes) == 2, notes
            red = bpy.data.materials["red"]
            assert groups_of(red.node_tree) == [("Alpenglow Light", False),
                                                ("Alpenglow Occlusion", False)]
            light = next(n for n in red.node_tree.nodes
                         if addon.nodes.is_group(n, addon.nodes.LIGHT))
            assert light.inputs["Original"].links[0].from_node.name == "Principled BSDF"
            _, notes = support.bake()
            assert not notes, notes


def test_remove_bake():
    for names in (["Alpenglow Light"], ["Alpenglow Occlusion"],
                  ["Alpenglow Occlusion", "Alpenglow Light"]):
        before = baked_scene(True)
        delete_groups(*names)
        save_and_load()
        assert bpy.ops.alpenglow.remove() == {"FINISHED"}
        support.check_state(before)


def test_other_links():
    """Links that the user has made since stay. A renamed node is not found."""
    baked_scene()
    delete_groups("Alpenglow Light")
    save_and_load()
    tree = bpy.data.materials["red"].node_tree
    glow = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(glow.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    addon.repair.repair()
    assert tree.nodes["Material Output"].inputs["Surface"].links[0].from_node == glow
    baked_scene()
    delete_groups("Alpenglow Light")
    save_and_load()
    bpy.data.materials["red"].node_tree.nodes["Principled BSDF"].name = "mine"
    assert addon.repair.repair() == ["material red: the node group Alpenglow Light was deleted; "
                                     "link the nodes that it connected again"]
    assert not addon.repair.repair()


support.main(test_bake_again, test_remove_bake, test_other_links)
