# SPDX-License-Identifier: MIT
"""Light of a whole scene: Cycles' path tracing of the original scene against the bake as Cycles
shows it. Nothing that the add-on writes takes part in the first picture."""

import math
import os
import sys

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()
WIDTH, HEIGHT, SAMPLES = 160, 120, 256
BLOCKS = 4, 4  # regions of the picture, down and across


def diffuse(name, colour):
    """A diffuse material. Principled ones also shine, which no light map shows."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    node = tree.nodes.new("ShaderNodeBsdfDiffuse")
    node.inputs["Color"].default_value = (*colour, 1)
    tree.links.new(node.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    return material


def emissive(name, image, strength):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    node, picture = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeTexImage")
    picture.image, node.inputs["Strength"].default_value = image, strength
    tree.links.new(picture.outputs["Color"], node.inputs["Color"])
    tree.links.new(node.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    return material


def waves(name, peak):
    """A smooth image of floats from 0.1 to `peak`."""
    image = bpy.data.images.new(name, 64, 64, float_buffer=True)
    y, x = 2 * numpy.pi / 64 * numpy.mgrid[0:64, 0:64]
    pixels = numpy.ones((64, 64, 4), numpy.float32)
    for channel, wave in enumerate((x, y, x + y)):
        pixels[..., channel] = 0.1 + (peak - 0.1) * (0.5 + 0.5 * numpy.sin(wave))
    image.pixels.foreach_set(pixels.ravel())
    return image


def scene():
    """A corner of three walls with blocks, all kinds of lamps, an even world, a bright screen."""
    settings = support.empty_scene()
    settings.size, settings.quality = 256, "MEDIUM"
    textured = diffuse("textured", (1, 1, 1))
    tree = textured.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = waves("paint", 0.8)
    tree.links.new(node.outputs["Color"], tree.nodes["Diffuse BSDF"].inputs["Color"])
    white, red = diffuse("white", (0.7, 0.7, 0.7)), diffuse("red", (0.7, 0.15, 0.1))
    support.add_mesh("plane", "floor", textured, size=6)
    support.add_mesh("plane", "back", white, size=6, location=(0, 3, 3),
                     rotation=(math.pi / 2, 0, 0))
    support.add_mesh("plane", "side", red, size=6, location=(-3, 0, 3),
                     rotation=(0, math.pi / 2, 0))
    support.add_mesh("cube", "block", white, size=1.4, location=(0.9, 0.6, 0.7),
                     rotation=(0, 0, 0.5))
    support.add_mesh("uv_sphere", "ball", red, radius=0.7, location=(-1.2, -0.2, 0.7))
    screen = emissive("screen", waves("bright", 6.0), 0.8)
    support.add_mesh("plane", "screen", screen, size=1.5, location=(-2.9, 1.2, 2),
                     rotation=(0, math.pi / 2, 0))
    sun = support.add_lamp("SUN", "sun", 1.5, (0, 0, 9), angle=math.radians(3))
    sun.rotation_euler = (0.5, 0.4, 0)
    support.add_lamp("POINT", "bulb", 40, (1.8, -1.4, 1.6), shadow_soft_size=0.0,
                     color=(1.0, 0.7, 0.4))
    panel = support.add_lamp("AREA", "panel", 150, (0.5, 0.5, 4), shape="RECTANGLE", size=2.0,
                             size_y=1.0, color=(0.7, 0.8, 1.0))
    panel.rotation_euler = (0.2, 0.1, 0.3)
    spot = support.add_lamp("SPOT", "spot", 200, (2.2, -2.2, 3.5), shadow_soft_size=0.0,
                            spot_size=0.7, spot_blend=0.0)
    spot.rotation_euler = (0.9, 0, 0.6)
    support.set_world((0.25, 0.3, 0.4))
    support.add_camera((4.6, -6.2, 4.2), (-0.4, 0.6, 1.5), WIDTH, HEIGHT)


def path_traced():
    """Cycles with all bounces, unclamped, without lamps in the picture."""
    cycles = bpy.context.scene.cycles
    cycles.max_bounces = cycles.diffuse_bounces = cycles.transparent_max_bounces = 64
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    for lamp in (o for o in bpy.context.scene.objects if o.type == "LIGHT"):
        lamp.visible_camera = False
    return support.render_cycles(SAMPLES)


def means(picture):
    down, across = BLOCKS
    return picture.reshape(down, HEIGHT // down, across, WIDTH // across, 3).mean(axis=(1, 3))


def test_scene():
    """Means of 40 x 30 pixels within 2 %, and of the picture within 1 %. The bake states an
    error of 1 %. Texels are wider than pixels, which shows at edges of shadows."""
    scene()
    traced = path_traced()
    _, notes = support.bake()
    shown = support.render_cycles(64)
    ratios = means(shown) / means(traced)
    total = shown.mean(axis=(0, 1)) / traced.mean(axis=(0, 1))
    print(f"bake / Cycles: {total.round(4)}, blocks {ratios.min():.4f} to {ratios.max():.4f}, mean "
          f"{traced.mean():.4f}; {notes}")
    assert traced.mean() > 0.2
    assert numpy.abs(total - 1).max() < 0.01, total
    assert numpy.abs(ratios - 1).max() < 0.02, ratios.round(3)


support.main(test_scene)
