# SPDX-License-Identifier: MIT
"""Materials: what is read from nodes, where the groups go, and that they come out again."""

import os
import sys

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()


def node_material(name, build):
    """A material whose surface is what `build(nodes, links)` returns."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    output = tree.get_output_node("ALL")
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    tree.links.new(build(tree.nodes, tree.links), output.inputs["Surface"])
    return material


def shader(nodes, kind, colour, strength=None):
    node = nodes.new(f"ShaderNode{kind}")
    node.inputs["Color"].default_value = (*colour, 1)
    if strength is not None:
        node.inputs["Strength"].default_value = strength
    return node.outputs[0]


def mixed(nodes, links, factor, a, b):
    mix = nodes.new("ShaderNodeMixShader")
    mix.inputs[0].default_value = factor
    links.new(a, mix.inputs[1])
    links.new(b, mix.inputs[2])
    return mix.outputs[0]


def read(name, build):
    found, notes = addon.surface.read(node_material(name, build))
    return found, notes


def near(a, b):
    return numpy.allclose(a, b, atol=1e-6)


def test_reading():
    support.empty_scene()
    found, notes = read("diffuse", lambda n, l: shader(n, "BsdfDiffuse", (0.1, 0.2, 0.3)))
    assert near(found.base.factor, (0.1, 0.2, 0.3)) and not notes
    found, notes = read("lamp", lambda n, l: shader(n, "Emission", (1, 0.5, 0), 4))
    assert near(found.emission.factor, (4, 2, 0)) and found.base.is_black() and not notes
    found, notes = read("half", lambda n, l: mixed(
        n, l, 0.25, shader(n, "BsdfDiffuse", (0.8, 0, 0)), shader(n, "Emission", (0, 1, 0), 2)))
    assert near(found.base.factor, (0.6, 0, 0)) and near(found.emission.factor, (0, 0.5, 0))
    found, notes = read("thin", lambda n, l: mixed(
        n, l, 0.3, shader(n, "BsdfTransparent", (1, 1, 1)), shader(n, "BsdfDiffuse", (1, 1, 1))))
    assert near(found.alpha, 0.3) and near(found.base.factor, (1, 1, 1)) and not notes
    found, notes = read("glass", lambda n, l: shader(n, "BsdfGlass", (0.9, 1, 0.9)))
    assert found.is_pane() and found.transmission == 1
    found, notes = read("hair", lambda n, l: shader(n, "BsdfHair", (0.9, 1, 0.9)))
    assert near(found.base.factor, (0.5, 0.5, 0.5)) and "is not read" in notes[0], notes
    assert near(addon.surface.read(None)[0].base.factor, (0.8, 0.8, 0.8))


def image_of(name, pixels, **options):
    """An image from floats [height][width][4], the first row at the bottom."""
    image = bpy.data.images.new(name, pixels.shape[1], pixels.shape[0], alpha=True, **options)
    image.pixels.foreach_set(numpy.float32(pixels).ravel())
    return image


def leaf(name, build):
    """A Principled material whose Alpha is what `build(nodes, links, image node)` returns."""
    material = support.add_material(name, (1, 1, 1))
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image_of(name, numpy.full((4, 4, 4), 0.5))
    principled = tree.nodes["Principled BSDF"]
    tree.links.new(build(tree.nodes, tree.links, node), principled.inputs["Alpha"])
    return material


def math(nodes, links, operation, *inputs):
    node = nodes.new("ShaderNodeMath")
    node.operation = operation
    for socket, value in zip(node.inputs, inputs):
        if isinstance(value, float):
            socket.default_value = value
        else:
            links.new(value, socket)
    return node.outputs[0]


def exported(material):
    """(glTF material, notes, writer) of a material."""
    exporter = addon.export.Exporter(bpy.context, False)
    exporter.material_index(material)
    return exporter.writer.document["materials"][0], exporter.notes, exporter.writer


def test_opacity():
    """Constants, an image's alpha, products and comparisons are read; all else costs a note."""
    support.empty_scene()
    element, notes, _ = exported(leaf("product", lambda n, l, i: math(
        n, l, "MULTIPLY", 0.5, math(n, l, "MULTIPLY", i.outputs["Alpha"], 0.5))))
    assert element["alphaMode"] == "BLEND" and not notes, notes
    assert near(element["pbrMetallicRoughness"]["baseColorFactor"], (1, 1, 1, 0.25))
    for name, operation, inputs, cutoff in (("above", "GREATER_THAN", (None, 0.3), 0.3),
                                            ("below", "LESS_THAN", (0.7, None), 0.7),
                                            ("round", "ROUND", (None,), 0.5)):
        element, notes, _ = exported(leaf(name, lambda n, l, i: math(
            n, l, operation, *(i.outputs["Alpha"] if x is None else x for x in inputs))))
        assert element["alphaMode"] == "MASK" and near(element["alphaCutoff"], cutoff), element
        assert not notes, notes
    for name, build in (
            ("colour", lambda n, l, i: i.outputs["Color"]),
            ("noise", lambda n, l, i: n.new("ShaderNodeTexNoise").outputs["Fac"]),
            ("two", lambda n, l, i: math(n, l, "MULTIPLY", i.outputs["Alpha"],
                                         n.new("ShaderNodeTexNoise").outputs["Fac"])),
            ("double", lambda n, l, i: math(n, l, "MULTIPLY", i.outputs["Alpha"], 2.0)),
            ("wrong side", lambda n, l, i: math(n, l, "GREATER_THAN", 0.5, i.outputs["Alpha"]))):
        element, notes, _ = exported(leaf(name, build))
        assert "alphaMode" not in element and len(notes) == 1, (name, element, notes)
        assert notes[0].startswith(f"{name}: ") and "is not read as opacity" in notes[0], notes
    found, notes = read("veil", lambda n, l: veil(n, l))
    assert found.alpha == 1 and "from a solid to a transparent shader" in notes[0], notes


def veil(nodes, links):
    shown = mixed(nodes, links, 0.5, shader(nodes, "BsdfDiffuse", (1, 1, 1)),
                  shader(nodes, "BsdfTransparent", (1, 1, 1)))
    links.new(nodes.new("ShaderNodeTexNoise").outputs["Fac"], shown.node.inputs[0])
    return shown


def pixels_of(writer, index):
    """The pixels [height][width][4] of an image of a .glb, the first row at the bottom."""
    start = writer.document["bufferViews"][writer.document["images"][index]["bufferView"]]
    path = os.path.join(support.FOLDER, "image.png")
    with open(path, "wb") as file:
        file.write(b"".join(writer.parts)[start["byteOffset"]:][:start["byteLength"]])
    image = bpy.data.images.load(path, check_existing=False)
    pixels = numpy.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)
    bpy.data.images.remove(image)
    return pixels


def test_other_alpha():
    """The alpha of another image than the colour's goes into one texture with the colour."""
    support.empty_scene()
    colours = numpy.random.default_rng(1).uniform(0, 1, (4, 4, 4))
    material = leaf("leaf", lambda n, l, i: i.outputs["Alpha"])
    tree = material.node_tree
    first = next(n for n in tree.nodes if n.type == "TEX_IMAGE").image
    alphas = numpy.linspace(0, 1, 16).reshape(4, 4, 1) * numpy.ones(4)
    first.pixels.foreach_set(numpy.float32(alphas).ravel())
    element, notes, writer = exported(material)
    assert element["alphaMode"] == "BLEND" and not notes, notes
    found = pixels_of(writer, 0)
    assert numpy.allclose(found[..., 3], alphas[..., 3], atol=1 / 255)
    assert (found[..., :3] == 1).all()
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image_of("colours", colours)
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    element, notes, writer = exported(material)
    found = pixels_of(writer, 0)
    assert element["alphaMode"] == "BLEND" and not notes, notes
    assert numpy.allclose(found[..., 3], alphas[..., 3], atol=1 / 255)
    assert numpy.allclose(found[..., :3], colours[..., :3], atol=1 / 255)
    node.image = image_of("larger", numpy.ones((8, 8, 4)))
    element, notes, writer = exported(material)
    assert "alphaMode" not in element and "has another size or UV map" in notes[0], notes


def test_constant_alpha():
    """The alpha of an image that only the colour of a surface reads does not count."""
    support.empty_scene()
    material = leaf("pane", lambda n, l, i: i.outputs["Alpha"])
    tree = material.node_tree
    principled = tree.nodes["Principled BSDF"]
    tree.links.remove(principled.inputs["Alpha"].links[0])
    principled.inputs["Alpha"].default_value = 0.5
    node = next(n for n in tree.nodes if n.type == "TEX_IMAGE")
    tree.links.new(node.outputs["Color"], principled.inputs["Base Color"])
    element, _, writer = exported(material)
    assert element["pbrMetallicRoughness"]["baseColorFactor"][3] == 0.5
    assert (pixels_of(writer, 0)[..., 3] == 1).all()


def test_bright_texture():
    """Emission of floats above 1 is divided by its maximum, which becomes the strength."""
    support.empty_scene()
    pixels = numpy.ones((4, 4, 4))
    pixels[..., :3] = numpy.linspace(0.5, 20, 16).reshape(4, 4, 1)
    material = support.add_material("screen", (0, 0, 0))
    tree = material.node_tree
    node, emission = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeEmission")
    node.image = image_of("bright", pixels, float_buffer=True)
    emission.inputs["Strength"].default_value = 3.0
    tree.links.new(node.outputs["Color"], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    element, notes, writer = exported(material)
    strength = element["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"]
    assert near(strength, 60) and near(element["emissiveFactor"], (1, 1, 1)), element
    assert len(notes) == 1 and notes[0].startswith("image bright emits up to 20: "), notes
    found = pixels_of(writer, 0)[..., 0]
    linear = numpy.where(found <= 0.04045, found / 12.92, ((found + 0.055) / 1.055) ** 2.4)
    assert numpy.allclose(60 * linear, 3 * pixels[..., 0], rtol=0.02), 60 * linear


def test_outputs():
    """An output of Cycles or of EEVEE alone is read and gets the map; none costs a note."""
    for target in ("CYCLES", "EEVEE"):
        support.empty_scene()
        red = node_material("red", lambda n, l: shader(n, "BsdfDiffuse", (0.5, 0, 0)))
        red.node_tree.get_output_node("ALL").target = target
        assert red.node_tree.get_output_node("ALL") is None
        support.add_mesh("plane", "plane", red)
        support.set_world((1, 1, 1))
        found, notes = addon.surface.read(red)
        assert near(found.base.factor, (0.5, 0, 0)) and not notes, (found, notes)
        support.bake()
        node = red.node_tree.get_output_node(target).inputs["Surface"].links[0].from_node
        assert addon.nodes.is_group(node, addon.nodes.LIGHT)
    bare = bpy.data.materials.new("bare")
    bare.use_nodes = True
    bare.node_tree.nodes.clear()
    assert addon.surface.read(bare)[1] == ["bare has no output node; it counts as black"]


def many_materials():
    """A cube of six materials, one of each kind, in front of a camera, and a floor without any."""
    settings = support.empty_scene()
    settings.size = 128
    cube = support.add_mesh("cube", "cube", location=(0, 0, 1), rotation=(0.6, 0.5, 0.3))
    plain = bpy.data.materials.new("no nodes")
    plain.diffuse_color = (0.2, 0.6, 0.3, 1)
    kinds = [support.add_material("a", (0.8, 0.1, 0.1)), plain,
             node_material("sum", lambda n, l: mixed(
                 n, l, 0.5, shader(n, "BsdfDiffuse", (0.2, 0.2, 0.9)),
                 shader(n, "BsdfDiffuse", (0.9, 0.9, 0.1)))),
             node_material("glow", lambda n, l: shader(n, "Emission", (0.9, 0.5, 0.1), 0.7)),
             support.add_material("b", (0.4, 0.4, 0.9)), support.add_material("c", (0.1, 0.1, 0.1))]
    for slot, material in enumerate(kinds):
        cube.data.materials.append(material)
        cube.data.polygons[slot].material_index = slot
    support.add_mesh("plane", "floor", size=8)
    support.set_world((0.6, 0.7, 0.9))
    support.add_lamp("SUN", "sun", 1.5, (0, 0, 5))
    support.add_camera((3.4, -2.6, 3.4), (0, 0, 0.7))
    return cube


def test_many_materials():
    cube = many_materials()
    baked, notes = support.bake_in(support.FOLDER)
    sky = ("--sky", "0.6,0.7,0.9")
    share = support.close_share(support.render_command(baked, *sky), support.render_cycles())
    print(f"six materials: {100 * share:.2f} % of pixels within 1/255; {notes}")
    assert share >= 0.99
    names = [s.material.name for s in cube.material_slots]
    assert names == ["a", "no nodes", "sum", "glow", "b", "c"], names


def test_shared():
    """A material that something else uses is copied; two baked objects share one."""
    many_materials()
    other = support.add_mesh("cube", "other", bpy.data.materials["a"], location=(3, 0, 1))
    other.hide_render = True  # not in the bake
    twin = support.add_mesh("cube", "twin", bpy.data.materials["b"], location=(-3, 0, 1))
    support.bake()
    assert other.data.materials[0].name == "a" and len(other.data.materials[0].node_tree.nodes) == 2
    cube = bpy.data.objects["cube"]
    assert cube.data.materials[0].name == "a.baked" and cube.data.materials[4].name == "b"
    assert twin.data.materials[0] == cube.data.materials[4]


def test_occlusion():
    """The group gives the numbers of `render --with ao`, and multiplies the colour by them."""
    settings = support.empty_scene()
    settings.what, settings.size = "OCCLUSION", 256
    white = support.add_material("white", (0.5, 0.25, 0.125))
    support.add_mesh("plane", "floor", white, size=6)
    support.add_mesh("monkey", "monkey", white, location=(0, 0, 1))
    support.add_camera((2.3, -2.6, 2.2), (0, 0, 0.7))
    baked, _ = support.bake_in(support.FOLDER)
    ours = support.render_command(baked, "--with", "ao")
    tree = white.node_tree
    group = next(n for n in tree.nodes if addon.nodes.is_group(n, addon.nodes.OCCLUSION))
    base = tree.nodes["Principled BSDF"].inputs["Base Color"]
    assert group.outputs["Color"].links[0].to_socket == base
    show = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(show.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    tree.links.new(group.outputs["Occlusion"], show.inputs["Color"])
    values = support.render_cycles()
    seen = values.max(axis=2) > 0
    difference = numpy.abs(ours - values).max(axis=2)[seen]
    print(f"occlusion: {100 * (difference <= 1 / 255).mean():.2f} % of pixels within 1/255, mean "
          f"{values[seen].mean():.3f}, darkest {values[seen].min():.3f}")
    assert (difference <= 1 / 255).mean() >= 0.99 and values[seen].min() < 0.5
    tree.links.new(group.outputs["Color"], show.inputs["Color"])
    coloured = support.render_cycles()
    assert numpy.allclose(coloured[seen], values[seen] * (0.5, 0.25, 0.125), atol=1e-4)


def links_of(material):
    return sorted((l.from_socket.name, l.from_node.name, l.to_socket.name, l.to_node.name)
                  for l in material.node_tree.links)


def blocks(picture):
    """Means of 40 x 40 pixels."""
    return picture.reshape(6, 40, 8, 40, 3).mean(axis=(1, 3))


def test_removal():
    """Without our nodes a material is as it was; "Baked" 0 shows the original."""
    many_materials()
    bpy.context.scene.alpenglow.what = "BOTH"
    materials = [bpy.data.materials[n] for n in ("a", "sum", "glow", "b")]
    before = [links_of(m) for m in materials]
    socket = materials[0].node_tree.nodes["Principled BSDF"].inputs["Base Color"]
    colour = tuple(socket.default_value)
    original = support.render_cycles(16)
    support.bake()
    for material in list(bpy.data.materials):
        for node in material.node_tree.nodes:
            if addon.nodes.is_group(node, addon.nodes.LIGHT):
                node.inputs["Baked"].default_value = 0
            if addon.nodes.is_group(node, addon.nodes.OCCLUSION):
                node.inputs["Strength"].default_value = 0
    again = blocks(support.render_cycles(16))
    worst = numpy.abs(again - blocks(original)).max() / original.mean()
    assert worst < 0.02, f"a block differs by {worst}"  # the baked light differs by .2
    for material, links in zip(materials, before):
        addon.nodes.remove(material.node_tree)
        assert links_of(material) == links, f"{material.name}: {links_of(material)}, was {links}"
    socket = materials[0].node_tree.nodes["Principled BSDF"].inputs["Base Color"]
    assert tuple(socket.default_value) == colour


support.main(test_reading, test_opacity, test_other_alpha, test_constant_alpha, test_bright_texture,
             test_outputs, test_many_materials, test_shared, test_occlusion, test_removal)
