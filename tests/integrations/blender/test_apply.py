# SPDX-License-Identifier: MIT
"""Results on unusual scenes: materials that show no map, stored nodes, instancers that cannot be
replaced, other scenes, parents and flags, UV maps of the user."""

import os
import sys

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()


def only(name, shader):
    """A scene of one object, whose material has one shader."""
    settings = support.empty_scene()
    material = support.add_material(name, (1, 1, 1))
    tree = material.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    node = tree.nodes.new(shader)
    tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    support.add_mesh("cube", "thing", material)
    support.add_lamp("POINT", "lamp", 200, (2, -2, 4))
    return settings


def fault_of_bake():
    """The message of a bake that fails. The scene must be as before."""
    before = support.state_of_scene()
    try:
        bpy.ops.alpenglow.bake()
    except RuntimeError as error:
        support.check_state(before)
        print(f"  {error}".rstrip())
        return str(error)
    raise AssertionError("the bake ended well")


def test_nothing_shows():
    only("glass", "ShaderNodeBsdfGlass")
    assert "no material can show the map, so nothing changed: material glass lets light through" \
        in fault_of_bake()
    only("glow", "ShaderNodeEmission").what = "OCCLUSION"
    assert "material glow has no colour for occlusion" in fault_of_bake()
    only("bare", "ShaderNodeBsdfDiffuse")
    tree = bpy.data.materials["bare"].node_tree
    tree.nodes.remove(tree.nodes["Material Output"])
    message = fault_of_bake()
    assert "material bare has no output" in message
    assert "the result of the command is kept in " in message
    kept = message.partition("is kept in ")[2].strip()
    assert sorted(os.path.splitext(n)[1] for n in os.listdir(kept)) == [".exr", ".glb"]
    only("glow", "ShaderNodeEmission").what = "BOTH"
    _, notes = support.bake()  # light shows
    assert any("glow has no colour for occlusion" in n for n in notes), notes


def nodes_of(material):
    return sorted(n.name for n in material.node_tree.nodes)


def test_stored_nodes():
    """Nodes of a material that does not use them stay."""
    support.floor_and_lamp()
    grey = bpy.data.materials["grey"]
    grey.use_nodes, grey.diffuse_color = False, (0.1, 0.9, 0.1, 1)
    before = support.state_of_material(grey)
    support.bake()
    assert support.state_of_material(grey) == before
    shown = bpy.data.objects["floor"].data.materials[0]
    assert shown.name == "grey.baked" and shown["alpenglow_source"] == grey
    node = next(n for n in shown.node_tree.nodes if addon.nodes.is_group(n, addon.nodes.LIGHT))
    assert numpy.allclose(node.inputs["Base Factor"].default_value, (0.1, 0.9, 0.1))
    support.bake()
    assert bpy.data.objects["floor"].data.materials[0] == shown


def test_nodes_go():
    """nodes.remove leaves links, muted ones too, and values as they were."""
    settings = support.floor_and_lamp()
    settings.what = "BOTH"
    tree = bpy.data.materials["grey"].node_tree
    colour = tree.nodes.new("ShaderNodeRGB")
    tree.links.new(colour.outputs[0], tree.nodes["Principled BSDF"].inputs[0]).is_muted = True
    before = support.state_of_material(bpy.data.materials["grey"])
    support.bake()
    assert support.state_of_material(bpy.data.materials["grey"]) != before
    assert addon.nodes.remove(tree) and not addon.nodes.remove(tree)
    assert support.state_of_material(bpy.data.materials["grey"]) == before


def instanced(*inner, name="inst"):
    """An instancer of a new collection with objects."""
    group = bpy.data.collections.new("group")
    for o in inner:
        for collection in list(o.users_collection):
            collection.objects.unlink(o)
        group.objects.link(o)
    shown = bpy.data.objects.new(name, None)
    shown.instance_type, shown.instance_collection = "COLLECTION", group
    shown.location = (0, 0, 1)
    bpy.context.scene.collection.objects.link(shown)
    return shown


def test_incomplete_instancer():
    settings = support.floor_and_lamp()
    shown = instanced(support.add_mesh("cube", "a", size=0.5), support.add_mesh("cube", "c"))
    bake = addon.bake.Bake(bpy.context, settings, "")
    bpy.data.objects["c"].data = bpy.data.objects["floor"].data
    assert bake.wait(bpy.context) == addon.bake.DONE, bake.message
    assert "inst stays as it is: inst/c has no result" in bake.notes, bake.notes
    assert shown.visible_get() and not shown.hide_render
    assert not [o for o in bpy.data.objects if o.name.endswith(".baked")]
    assert "Alpenglow" in bpy.data.objects["floor"].data.uv_layers


def test_other_instances():
    """Volumes and Grease Pencil of an instanced collection get copies; hair keeps its object."""
    support.floor_and_lamp()
    bpy.ops.object.gpencil_add(type="STROKE")
    strokes = bpy.context.object
    bpy.ops.object.volume_add()
    volume = bpy.context.object
    shown = instanced(support.add_mesh("cube", "a", size=0.5), strokes, volume)
    support.bake()
    assert shown.hide_render and not shown.visible_get()
    made = {o.type for o in bpy.data.objects if o.get("alpenglow_source") == shown}
    assert made == {"MESH", "GPENCIL", "VOLUME"}, made
    support.floor_and_lamp()
    fur = support.add_mesh("cube", "fur", location=(0, 0, 1))
    fur.modifiers.new("more", "SUBSURF")
    fur.modifiers.new("hair", "PARTICLE_SYSTEM")
    fur.particle_systems[0].settings.type = "HAIR"
    _, notes = support.bake()
    assert "fur stays as it is: the hair of fur takes no part in a bake" in notes, notes
    assert fur.visible_get() and "fur.baked" not in bpy.data.objects


def test_background_scene():
    """Objects of a scene in the background are not in the view layer."""
    support.floor_and_lamp()
    behind = bpy.data.scenes.new("behind")
    text = bpy.data.objects.new("text", bpy.data.curves.new("text", "FONT"))
    text.data.body = "A"
    behind.collection.objects.link(text)
    bpy.context.scene.background_set = behind
    try:
        _, notes = support.bake()
        assert any(n.startswith("text is in a background scene") for n in notes), notes
        assert not text.hide_render and "text.baked" not in bpy.data.objects
    finally:
        bpy.data.scenes.remove(behind)


def test_renamed():
    """Renamed objects and another scene in the window do not matter."""
    settings = support.floor_and_lamp()
    inner = support.add_mesh("cube", "a", size=0.5)
    shown = instanced(inner)
    bend = support.add_mesh("cube", "grown", location=(2, 0, 1))
    bend.modifiers.new("more", "SUBSURF")
    scene, other = bpy.context.scene, bpy.data.scenes.new("other")
    bake = addon.bake.Bake(bpy.context, settings, "")
    bpy.data.objects["floor"].name, inner.name, shown.name = "ground", "b", "new inst"
    bend.name, scene.name = "changed", "renamed scene"
    bpy.context.window.scene = other
    try:
        assert bake.wait(bpy.context) == addon.bake.DONE, bake.message
        assert not bake.notes, bake.notes
        assert not other.objects and len([o for o in scene.objects if "baked" in o.name]) == 2
        assert "Alpenglow" in bpy.data.objects["ground"].data.uv_layers
        layer = scene.view_layers[0]
        assert not shown.visible_get(view_layer=layer) and not bend.visible_get(view_layer=layer)
    finally:
        bpy.context.window.scene = scene
        bpy.data.scenes.remove(other)


def test_kept_result():
    """The result of a bake whose scene has gone lies beside the .blend."""
    settings = support.floor_and_lamp()
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(support.FOLDER, "Wohnung.blend"))
    settings = bpy.context.scene.alpenglow
    bake = addon.bake.Bake(bpy.context, settings, "")
    bake.place.scene = ("gone", -1)
    assert bake.wait(bpy.context) == addon.bake.FAILED
    assert "the scene or the view layer was removed" in bake.message
    assert bake.kept.startswith(os.path.join(support.FOLDER, "Wohnung.baked-")), bake.message
    assert bake.kept in bake.message
    addon.apply.Result(os.path.join(bake.kept, "baked.glb"))


def test_parents_and_flags():
    support.floor_and_lamp()
    parent = bpy.data.objects.new("parent", None)
    parent.rotation_euler, parent.scale, parent.location = (0.3, 0.2, 1), (1, 2, 1), (1, 0, 1)
    bpy.context.scene.collection.objects.link(parent)
    grown = support.add_mesh("cube", "grown", size=1, location=(0.5, 0.2, 0.1))
    grown.modifiers.new("more", "SUBSURF")
    grown.parent, grown.rotation_euler = parent, (0, 0.4, 0)
    second = bpy.data.collections.new("second")
    bpy.context.scene.collection.children.link(second)
    second.objects.link(grown)
    grown.visible_shadow, grown.visible_camera, grown.hide_select = False, False, True
    support.bake()
    bpy.context.view_layer.update()
    made = bpy.data.objects["grown.baked"]
    assert made.parent == parent and not made.visible_shadow and not made.visible_camera
    assert made.hide_select and set(made.users_collection) == set(grown.users_collection)
    assert numpy.allclose(made.matrix_world, grown.matrix_world, atol=1e-5)
    parent.location.x += 1
    bpy.context.view_layer.update()
    assert numpy.allclose(made.matrix_world, grown.matrix_world, atol=1e-5)


def test_no_uv_map():
    """Textures of a mesh without UV maps read the same place after a bake."""
    support.floor_and_lamp()
    mesh = bpy.data.objects["floor"].data
    while mesh.uv_layers:
        mesh.uv_layers.remove(mesh.uv_layers[0])
    support.bake()
    assert [u.name for u in mesh.uv_layers] == ["Alpenglow"], "a plain material needs no other"
    bpy.ops.alpenglow.remove()
    assert not mesh.uv_layers
    tree = bpy.data.materials["grey"].node_tree
    picture = tree.nodes.new("ShaderNodeTexImage")
    picture.image = bpy.data.images.new("picture", 2, 2)
    picture.image.pixels = [0.9, 0.1, 0.1, 1] + [0.1, 0.1, 0.9, 1] * 3
    tree.links.new(picture.outputs[0], tree.nodes["Principled BSDF"].inputs[0])
    support.add_camera((0, -3, 5), (0, 0, 0), 32, 24)
    before = support.render_cycles(4)
    support.bake()
    assert [(u.name, u.active_render) for u in mesh.uv_layers] == \
        [("UVMap", True), ("Alpenglow", False)]
    for node in tree.nodes:
        if addon.nodes.is_group(node, addon.nodes.LIGHT):
            node.inputs["Baked"].default_value = 0
    assert numpy.allclose(support.render_cycles(4), before, atol=1e-4)


def test_map_of_user():
    """A UV map of the user that has our name stays."""
    support.floor_and_lamp()
    mesh = bpy.data.objects["floor"].data
    mesh.uv_layers[0].name = "Alpenglow"
    mesh.uv_layers[0].data.foreach_set("uv", numpy.arange(8, dtype=numpy.float32))
    support.add_mesh("cube", "cube", bpy.data.materials["grey"], size=1, location=(0, 0, 2))
    for _ in range(2):
        _, notes = support.bake()
        assert "floor has a UV map Alpenglow that no bake made: the map of the bake is " \
            "Alpenglow.001" in notes, notes
        assert [u.name for u in mesh.uv_layers] == ["Alpenglow", "Alpenglow.001"]
        assert [x for d in mesh.uv_layers[0].data for x in d.uv] == list(range(8))
        for name, uv_map in (("floor", "Alpenglow.001"), ("cube", "Alpenglow")):
            tree = bpy.data.objects[name].data.materials[0].node_tree
            assert [n.uv_map for n in tree.nodes if n.type == "UVMAP"] == [uv_map]


support.main(test_nothing_shows, test_stored_nodes, test_nodes_go, test_incomplete_instancer,
             test_other_instances, test_background_scene, test_renamed, test_kept_result,
             test_parents_and_flags, test_no_uv_map, test_map_of_user)
