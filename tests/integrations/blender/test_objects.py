# SPDX-License-Identifier: MIT
"""Instances, modifiers, curves, names, linked files: the object that takes the result, and whether
it is the light of its place. Pictures by Cycles are compared as in test_values.py."""

import os
import sys

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()
NAME = "Übergröße 椅子"


def floor_and_lamp():
    settings = support.empty_scene()
    settings.size = 256
    support.add_mesh("plane", "floor", support.add_material("grey", (0.6, 0.6, 0.6)), size=10)
    support.add_lamp("POINT", "lamp", 600, (2.5, -2, 5))
    support.add_camera((4.5, -5.5, 4.5), (0, 0, 0.6))
    return settings


def object_of(name):
    found = bpy.data.objects.get(name)
    assert found is not None, f"{name} is not among {bpy.data.objects.keys()}"
    return found


def shows_map(o):
    return addon.nodes.UV_MAP in o.data.uv_layers and all(
        any(addon.nodes.is_group(n, addon.nodes.LIGHT) for n in s.material.node_tree.nodes)
        for s in o.material_slots) and len(o.material_slots) > 0


def compare():
    baked, notes = support.bake_in(support.FOLDER)
    ours, cycles = support.render_command(baked), support.render_cycles()
    share = support.close_share(ours, cycles)
    print(f"{100 * share:.2f} % of pixels within 1/255, mean {cycles.mean():.4f}; {notes}")
    assert ours.mean() > 0.02 and share >= 0.99
    return notes


def test_instances():
    floor_and_lamp()
    first = support.add_mesh("cube", "first", support.add_material("m", (0.8, 0.2, 0.2)), size=1,
                             location=(-1, 0, 0.5))
    second = bpy.data.objects.new("second", first.data)
    second.location, second.scale = (1, 0, 1), (-1, 2, 1)
    bpy.context.scene.collection.objects.link(second)
    group = bpy.data.collections.new("group")
    support.add_mesh("monkey", "inner", support.add_material("n", (0.2, 0.7, 0.2)))
    inner = object_of("inner")
    bpy.context.scene.collection.objects.unlink(inner)
    group.objects.link(inner)
    group.objects.link(support.add_lamp("POINT", "inner lamp", 60, (0.8, -1, 0.6)))
    bpy.context.scene.collection.objects.unlink(object_of("inner lamp"))
    for place in ((0, 2, 1), (2.2, 1.5, 1)):
        empty = bpy.data.objects.new("copy", None)
        empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", group, place
        bpy.context.scene.collection.objects.link(empty)
    compare()
    with open(os.path.join(support.FOLDER, "scene.glb"), "rb") as file:
        assert file.read().count(b'"name":"inner lamp","color"') == 2, "lamps of the instances"
    assert first.data != second.data, "linked duplicates share one UV map"
    assert shows_map(first) and shows_map(second)
    for name in ("copy/inner.baked", "copy.001/inner.baked"):
        assert shows_map(object_of(name))
    lamp = object_of("copy.001/inner lamp.baked")
    assert lamp.type == "LIGHT" and numpy.allclose(lamp.matrix_world.translation, (3, 0.5, 1.6))
    assert object_of("copy").hide_render and not object_of("copy").visible_get()
    assert not shows_map(inner) and addon.nodes.UV_MAP not in inner.data.uv_layers
    assert len(bpy.data.materials["n"].node_tree.nodes) == 2, "the material of the original changed"
    compare()  # again, without the instancers
    with open(os.path.join(support.FOLDER, "scene.glb"), "rb") as file:
        assert file.read().count(b'"name":"inner lamp","color"') == 2, "lamps of hidden instancers"


def scatter(kind):
    """A small grid that shows a ball at each vertex, or on each face by particles."""
    grid = support.add_mesh("grid", "grid", support.add_material("g", (0.3, 0.3, 0.6)), size=3,
                            x_subdivisions=2, y_subdivisions=2, location=(0, 0, 0.6))
    ball = support.add_mesh("ico_sphere", "ball", support.add_material("r", (0.7, 0.2, 0.2)),
                            radius=0.3, location=(0, 0, 20))
    if kind == "vertices":
        ball.parent, grid.instance_type = grid, "VERTS"
        ball.location = (0, 0, 0)
        return grid
    if kind == "particles":
        grid.modifiers.new("particles", "PARTICLE_SYSTEM")
        settings = grid.particle_systems[0].settings
        settings.type, settings.count, settings.render_type = "HAIR", 5, "OBJECT"
        settings.instance_object, settings.particle_size, settings.use_advanced_hair = ball, 1, True
        return grid
    tree = bpy.data.node_groups.new("scatter", "GeometryNodeTree")
    addon.nodes.add_socket(tree, "INPUT", "NodeSocketGeometry", "Geometry")
    addon.nodes.add_socket(tree, "OUTPUT", "NodeSocketGeometry", "Geometry")
    given, result = addon.nodes.ends(tree)
    place, cube = (tree.nodes.new(f"GeometryNode{n}") for n in ("InstanceOnPoints", "MeshCube"))
    cube.inputs["Size"].default_value = (0.4, 0.4, 0.4)
    tree.links.new(given[0], place.inputs["Points"])
    tree.links.new(cube.outputs[0], place.inputs["Instance"])
    tree.links.new(place.outputs[0], result[0])
    grid.modifiers.new("scatter", "NODES").node_group = tree
    return grid


def test_scatter():
    for kind, count in (("vertices", 9), ("nodes", 9), ("particles", 5)):
        floor_and_lamp()
        grid = scatter(kind)
        compare()
        made = [o for o in bpy.data.objects if o.name.startswith("grid") and o != grid
                and not o.name.startswith("grid.baked")]
        if kind == "nodes":  # their instances have no name but the grid's
            made = [o for o in bpy.data.objects if o.name.startswith("grid.baked")]
        print(f"{kind}: {len(made)} instances")
        assert len(made) == count and all(shows_map(o) for o in made), [o.name for o in made]
        assert grid.hide_render and not grid.visible_get()


def test_modifiers():
    floor_and_lamp()
    grown = support.add_mesh("cube", NAME, support.add_material("ß", (0.8, 0.3, 0.1)), size=1.4,
                             location=(-1, 0, 0.8))
    grown.modifiers.new("more", "SUBSURF").levels = 2
    bent = support.add_mesh("cylinder", "bent", support.add_material("b", (0.3, 0.4, 0.8)),
                            radius=0.5, location=(1, 0, 1.2))
    bend = bent.modifiers.new("bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.angle, bend.deform_axis = "TWIST", 1.0, "Z"
    compare()
    assert shows_map(bent) and bpy.data.objects.get("bent.baked") is None
    assert len(bent.modifiers) == 1
    baked = object_of(f"{NAME}.baked")
    assert shows_map(baked) and len(baked.data.polygons) == 96
    assert grown.hide_render and not grown.visible_get() and len(grown.modifiers) == 1
    assert len(grown.data.uv_layers) == 1 and grown.data.materials[0].name == "ß"
    count = len(bpy.data.objects)
    compare()  # a second bake takes NAME.baked as it is
    assert len(bpy.data.objects) == count and shows_map(object_of(f"{NAME}.baked"))
    grown.hide_render = False
    grown.hide_set(False)
    compare()  # the original shows again: it stands for its copy, which is replaced
    assert len(bpy.data.objects) == count and shows_map(object_of(f"{NAME}.baked"))


def test_names_of_copies():
    """Objects, meshes and materials of repeated bakes keep their names."""
    settings = floor_and_lamp()
    settings.size = 64
    shared = support.add_material("red", (0.8, 0.1, 0.1))
    support.add_mesh("cube", "grown", shared).modifiers.new("more", "SUBSURF")
    support.add_mesh("cube", "inner", shared, location=(2, 0, 0)).modifiers.new("more", "SUBSURF")
    for _ in range(3):
        for name in ("grown", "inner"):
            object_of(name).hide_render = False
            object_of(name).hide_set(False)
        support.bake()
        assert object_of("grown.baked").data.name == "grown.baked"
        assert object_of("grown.baked").data.materials[0].name == "red.baked"
        names = sorted(m.name for m in bpy.data.materials)
        assert names == ["grey", "red", "red.baked"], names
        assert not [o.name for o in bpy.data.objects if o.name.endswith(".001")]


def test_curves():
    floor_and_lamp()
    text = bpy.data.curves.new("text", "FONT")
    text.body, text.extrude = "Ag", 0.1
    shown = bpy.data.objects.new("text", text)
    shown.rotation_euler, shown.location = (1.2, 0, 0.3), (-0.5, 0, 0.2)
    bpy.context.scene.collection.objects.link(shown)
    compare()
    assert shows_map(object_of("text.baked")) and shown.hide_render


def test_selected():
    settings = floor_and_lamp()
    support.add_mesh("cube", "other", bpy.data.materials["grey"], size=1, location=(0, 0, 0.5))
    bpy.ops.object.select_all(action="DESELECT")
    object_of("floor").select_set(True)
    settings.scope = "SELECTED"
    support.bake()
    assert shows_map(object_of("floor")) and not shows_map(object_of("other"))
    assert object_of("other").material_slots[0].material.name == "grey"
    assert object_of("floor").material_slots[0].material.name == "grey.baked"
    bpy.ops.object.select_all(action="DESELECT")
    try:
        bpy.ops.alpenglow.bake()
        raise AssertionError("a bake of nothing")
    except RuntimeError as error:
        assert "nothing to bake: select objects" in str(error), error


def test_linked():
    path = os.path.join(support.FOLDER, "library.blend")
    support.empty_scene()
    support.add_mesh("cube", "stone", support.add_material("rock", (0.4, 0.4, 0.4)), size=1)
    bpy.data.libraries.write(path, {object_of("stone")})
    floor_and_lamp()
    with bpy.data.libraries.load(path, link=True) as (source, target):
        target.objects = source.objects
    stone = target.objects[0]
    bpy.context.scene.collection.objects.link(stone)
    group = bpy.data.collections.new("stones")
    group.objects.link(stone)
    copy = bpy.data.objects.new("copy", None)
    copy.instance_type, copy.instance_collection, copy.location = "COLLECTION", group, (2, 0, 0.5)
    bpy.context.scene.collection.objects.link(copy)
    override = stone.override_create()
    override.name, override.location = "override", (0, 2, 0.5)
    bpy.context.scene.collection.objects.link(override)
    mine = bpy.data.objects.new("mine~", stone.data)
    mine.location = (-2, 0, 0.5)
    bpy.context.scene.collection.objects.link(mine)
    _, notes = support.bake()
    assert any(n.startswith("stone is linked from another file: it shades") for n in notes), notes
    assert shows_map(mine) and mine.data.library is None
    assert shows_map(object_of("copy/stone.baked"))
    assert mine.data.materials[0].library is None and mine.data.materials[0].name == "rock.baked"
    assert any(n.startswith("override is linked from another file") for n in notes), notes
    assert not shows_map(stone) and stone.visible_get() and not shows_map(override)


def test_old_maps():
    """A bake replaces the maps of the bake before."""
    settings = floor_and_lamp()
    settings.what = "BOTH"
    support.bake()
    settings.what = "OCCLUSION"
    support.bake()
    kinds = [n.label for n in object_of("floor").data.materials[0].node_tree.nodes if n.label]
    assert kinds == [addon.nodes.OCCLUSION], kinds
    maps = [i.name for i in bpy.data.images if i.get("alpenglow")]
    assert maps == ["Alpenglow occlusion"], maps


def test_cut_normals():
    """Polygons in two charts are cut; the surface, custom normals and weights stay."""
    support.empty_scene()
    support.add_mesh("monkey", "monkey")
    bpy.ops.object.shade_smooth()
    mesh = object_of("monkey").data
    bpy.context.object.vertex_groups.new(name="weight").add(range(20), 0.5, "REPLACE")
    mesh.use_auto_smooth = True
    vertices = numpy.array([v.co for v in mesh.vertices])
    mesh.normals_split_custom_set_from_vertices((vertices + 1e-3).tolist())
    before = normal_at_corners(mesh)
    polygons, area = len(mesh.polygons), sum(p.area for p in mesh.polygons)
    bpy.context.scene.alpenglow.what = "OCCLUSION"
    _, notes = support.bake()
    assert any("lie in two charts" in n for n in notes) and len(mesh.polygons) > polygons, notes
    assert support.close(sum(p.area for p in mesh.polygons), area, 0.01)
    assert len(mesh.vertices) == len(vertices) and mesh.vertices[3].groups[0].weight == 0.5
    after = normal_at_corners(mesh)
    worst = max(min(numpy.abs(n - m).max() for m in before[v]) for v in after for n in after[v])
    # Blender keeps custom normals as two 16-bit angles; a cut that loses them moves some by 1.
    assert worst < 5e-3, f"a normal moved by {worst}"


def test_cut_plain_normals():
    """A cut moves no normal of meshes without custom ones: flat, smooth, and smooth with sharp
    edges that count or do not."""
    for is_smooth, has_auto, is_sharp in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 0, 1)):
        support.empty_scene().what = "OCCLUSION"
        mesh = support.add_mesh("monkey", "monkey").data
        mesh.polygons.foreach_set("use_smooth", [is_smooth] * len(mesh.polygons))
        mesh.use_auto_smooth = bool(has_auto)
        mesh.edges.foreach_set("use_edge_sharp", [is_sharp and i % 3 == 0
                                                  for i in range(len(mesh.edges))])
        rows = [frozenset(mesh.loops[i].vertex_index for i in p.loop_indices)
                for p in mesh.polygons]
        before = [dict(zip((mesh.loops[i].vertex_index for i in p.loop_indices),
                           addon.export.Loops(mesh).normals[list(p.loop_indices)]))
                  for p in mesh.polygons]
        _, notes = support.bake()
        assert any("lie in two charts" in n for n in notes), notes
        normals, worst = addon.export.Loops(mesh).normals, 0.0
        for polygon in mesh.polygons:
            three = frozenset(mesh.loops[i].vertex_index for i in polygon.loop_indices)
            whole = before[next(i for i, row in enumerate(rows) if three <= row)]
            for i in polygon.loop_indices:
                cosine = numpy.dot(normals[i], whole[mesh.loops[i].vertex_index])
                worst = max(worst, numpy.degrees(numpy.arccos(min(1.0, float(cosine)))))
        print(f"  smooth {is_smooth}, auto {has_auto}, sharp {is_sharp}: {worst:.3f} degrees")
        assert worst < 0.5, worst  # two 16-bit angles
        assert "alpenglow_loop" not in mesh.attributes


def test_cut_coordinates():
    """After the cut every triangle has the coordinates that the command gave it."""
    support.empty_scene().what = "OCCLUSION"
    mesh = support.add_mesh("monkey", "monkey").data
    vertex_of_loop = [loop.vertex_index for loop in mesh.loops]
    out, notes = support.bake_in(support.FOLDER)
    assert "lie in two charts" in notes[0], notes
    loops, places = addon.apply.Result(out).corners(0, len(vertex_of_loop))
    wanted = {frozenset((vertex_of_loop[i], *uv) for i, uv in zip(three, uvs))
              for three, uvs in zip(loops.tolist(), places.tolist())}
    layer = mesh.uv_layers[addon.nodes.UV_MAP].data
    mesh.calc_loop_triangles()
    found = {frozenset((mesh.loops[i].vertex_index, *layer[i].uv) for i in t.loops)
             for t in mesh.loop_triangles}
    assert len(wanted) == len(loops) and found == wanted, len(wanted - found)


def normal_at_corners(mesh):
    found = {}
    normals = addon.export.Loops(mesh).normals
    for loop, normal in zip(mesh.loops, normals):
        found.setdefault(loop.vertex_index, []).append(normal)
    return found


support.main(test_instances, test_scatter, test_modifiers,
             test_names_of_copies, test_curves, test_selected, test_linked,
             test_old_maps, test_cut_normals, test_cut_plain_normals, test_cut_coordinates)
