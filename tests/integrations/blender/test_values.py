# SPDX-License-Identifier: MIT
"""The node groups show what `alpenglow render` shows: pictures by Cycles against the command's.

Cycles takes one sample of emission at the middle of a pixel, as the command does. 1 % of the pixels
may differ by more than 1/255: both programs decide the edges of triangles by their own rounding."""

import os
import sys

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()


def room():
    settings = support.empty_scene()
    settings.size = 256
    red = support.add_material("red", (0.8, 0.1, 0.05))
    white = support.add_material("white", (0.75, 0.75, 0.75))
    support.add_mesh("cube", "room", white, size=6, location=(0, 0, 3))
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.flip_normals()
    bpy.ops.object.mode_set(mode="OBJECT")
    support.add_mesh("monkey", "monkey", red, location=(0.2, 0, 1.2))
    bpy.ops.object.shade_smooth()
    support.add_mesh("uv_sphere", "ball", None, location=(-1.7, 0.4, 1))
    lit = support.add_material("lit", (1.0, 0.8, 0.5), 3.0)
    support.add_mesh("plane", "plate", lit, size=2, location=(0, 0, 5.5), rotation=(3.14159, 0, 0))
    support.add_lamp("POINT", "lamp", 120, (1.5, -1.5, 4))
    support.add_camera((2.3, -2.6, 3.2), (-0.3, 0.4, 1.2))
    return settings


def add_picture(material):
    """A smooth texture on the base colour of a material. Cycles interpolates sRGB bytes, the
    command their linear values, which differ at steps."""
    image = bpy.data.images.new(f"waves {material.name}", 256, 256)
    y, x = 2 * numpy.pi / 256 * numpy.mgrid[0:256, 0:256]
    pixels = numpy.ones((256, 256, 4), numpy.float32)
    for channel, wave in enumerate((x, y, x + 2 * y)):
        pixels[..., channel] = 0.55 + 0.4 * numpy.sin(wave)
    image.pixels.foreach_set(pixels.ravel())
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])


def add_turned_emission(o, material):
    """The texture of `material` also emits, by a second UV map that is turned and larger."""
    first = o.data.uv_layers.active
    uvs = numpy.array([d.uv for d in first.data])
    second = o.data.uv_layers.new(name="second", do_init=False)
    second.data.foreach_set("uv", numpy.float32(2 * uvs[:, ::-1] + 0.1).ravel())
    first.active_render = True
    tree = material.node_tree
    node, place = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeUVMap")
    node.image, place.uv_map = bpy.data.images[f"waves {material.name}"], "second"
    principled = tree.nodes["Principled BSDF"]
    tree.links.new(place.outputs["UV"], node.inputs["Vector"])
    tree.links.new(node.outputs["Color"], addon.surface.first_input(
        principled, "Emission Color", "Emission"))
    principled.inputs["Emission Strength"].default_value = 0.5


def test_two_uv_maps():
    """Colour and emission of one material by two UV maps."""
    room()
    red = bpy.data.materials["red"]
    add_picture(red)
    add_turned_emission(bpy.data.objects["monkey"], red)
    baked, notes = support.bake_in(support.FOLDER)
    share = support.close_share(support.render_command(baked), support.render_cycles())
    print(f"two UV maps: {100 * share:.2f} % of pixels within 1/255; {notes}")
    assert share >= 0.99


def test_light():
    room()
    baked, _ = support.bake_in(support.FOLDER)
    ours = support.render_command(baked)
    cycles = support.render_cycles()
    share = support.close_share(ours, cycles)
    print(f"light: {100 * share:.2f} % of pixels within 1/255, means {ours.mean():.4f} "
          f"{cycles.mean():.4f}")
    assert ours.mean() > 0.05 and share >= 0.99


def test_textures():
    """Occlusion beside light does not darken the light, which holds all shade."""
    room().what = "BOTH"
    add_picture(bpy.data.materials["white"])
    add_picture(bpy.data.materials["red"])
    baked, notes = support.bake_in(support.FOLDER)
    ours = support.render_command(baked)
    cycles = support.render_cycles()
    share = support.close_share(ours, cycles)
    print(f"textures: {100 * share:.2f} % of pixels within 1/255; {notes}")
    assert share >= 0.99


def test_mask():
    """A leaf whose texture cuts it: what lies behind shows through."""
    room()
    leaf = support.add_material("leaf", (1, 1, 1))
    image = bpy.data.images.new("leaf", 64, 64, alpha=True)
    y, x = numpy.mgrid[0:64, 0:64] - 31.5
    pixels = numpy.ones((64, 64, 4), numpy.float32) * (0.2, 0.6, 0.1, 1)
    pixels[..., 3] = numpy.hypot(x, y) < 24
    image.pixels.foreach_set(numpy.float32(pixels).ravel())
    tree = leaf.node_tree
    node, step = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeMath")
    node.image, step.operation = image, "GREATER_THAN"
    step.inputs[1].default_value = 0.5
    principled = tree.nodes["Principled BSDF"]
    tree.links.new(node.outputs["Color"], principled.inputs["Base Color"])
    tree.links.new(node.outputs["Alpha"], step.inputs[0])
    tree.links.new(step.outputs[0], principled.inputs["Alpha"])
    support.add_mesh("plane", "leaf", leaf, size=1.6, location=(1.0, -1.4, 2),
                     rotation=(1.2, 0, 0.7))
    baked, notes = support.bake_in(support.FOLDER)
    share = support.close_share(support.render_command(baked), support.render_cycles())
    print(f"mask: {100 * share:.2f} % of pixels within 1/255; {notes}")
    assert share >= 0.99


support.main(test_light, test_textures, test_two_uv_maps, test_mask)
