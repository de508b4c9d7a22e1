# SPDX-License-Identifier: MIT
"""Units of lamps and world: E of a plane by closed forms, by the command and by Cycles.

A plane of albedo 0.5 lies in the origin, and nothing reflects onto it. Cycles shows 0.5 E / pi."""

import json
import math
import os
import struct
import subprocess
import sys

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()
POWER, HEIGHT = 100.0, 3.0


def plane(size=0.2):
    settings = support.empty_scene()
    bpy.context.scene.world = None
    settings.size, settings.quality = 16, "HIGH"
    grey = bpy.data.materials.new("grey")
    grey.use_nodes = True
    tree = grey.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (0.5, 0.5, 0.5, 1)
    tree.links.new(diffuse.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    shown = support.add_mesh("plane", "plane", grey, size=size)
    support.add_camera((0, -0.01, 1), (0, 0, 0), 8, 8)
    bpy.context.scene.camera.data.angle = math.radians(2)
    return shown


def irradiance_by_cycles():
    return float(support.render_cycles(4096).mean(axis=(0, 1))[1]) * math.pi / 0.5


def irradiance_of_bake(shown):
    """E at the middle of the plane, read as a node does: texel by UV, x intensity x pi."""
    support.bake()
    light = next(i for i in bpy.data.images if i.get("alpenglow") == "light")
    assert light["units"] == "irradiance/pi"
    pixels = numpy.array(light.pixels[:]).reshape(light.size[1], light.size[0], light.channels)
    uvs = numpy.array([d.uv for d in shown.data.uv_layers[addon.nodes.UV_MAP].data])
    x, y = uvs.mean(axis=0) * light.size
    tree = shown.data.materials[0].node_tree
    group = next(n for n in tree.nodes if addon.nodes.is_group(n, addon.nodes.LIGHT))
    return float(pixels[int(y), int(x), 1]) * group.inputs["Intensity"].default_value * math.pi


def check(name, shown, expected, tolerance=0.01):
    cycles, ours = irradiance_by_cycles(), irradiance_of_bake(shown)
    print(f"{name}: E {expected:.5f} W/m2, Cycles {cycles:.5f}, bake {ours:.5f}")
    assert support.close(cycles, expected, 0.01), f"{name}: the formula is not that of Cycles"
    assert support.close(ours, expected, tolerance), f"{name}: the bake"


def test_formulas():
    lamps = addon.lamps
    assert support.close(lamps.intensity_of(4 * math.pi), 1, 1e-12)
    assert support.close(lamps.radiance_of(8, 2), 1, 1e-12)
    inner, outer = lamps.cone_of(math.pi / 2, 0.5)
    assert support.close(outer, math.pi / 4, 1e-12)
    assert support.close(math.cos(inner), (1 + math.cos(outer)) / 2, 1e-9)
    assert lamps.cone_of(math.pi / 2, 0)[0] < outer


def test_point():
    """E = P / (4 pi h^2): 100 W at 3 m, seen at 0 degrees."""
    shown = plane()
    support.add_lamp("POINT", "lamp", POWER, (0, 0, HEIGHT), shadow_soft_size=0.0)
    check("point", shown, POWER / (4 * math.pi * HEIGHT ** 2))


def test_spot():
    """The middle of a cone has the intensity of a point lamp."""
    shown = plane()
    support.add_lamp("SPOT", "lamp", POWER, (0, 0, HEIGHT), shadow_soft_size=0.0, spot_size=1.0,
                     spot_blend=0.2)
    check("spot", shown, POWER / (4 * math.pi * HEIGHT ** 2))


def test_sun():
    """E = S cos(30 degrees)."""
    shown = plane()
    sun = support.add_lamp("SUN", "sun", 4.0, (0, 0, HEIGHT), angle=math.radians(0.5))
    sun.rotation_euler = (0, math.radians(30), 0)
    check("sun", shown, 4.0 * math.cos(math.radians(30)))


def disk(radius):
    """E = pi L r^2 / (r^2 + h^2) under the middle of a disk of radiance L = P / (4 A)."""
    area = math.pi * radius ** 2
    return math.pi * POWER / (4 * area) * radius ** 2 / (radius ** 2 + HEIGHT ** 2)


def test_area():
    shown = plane()
    support.add_lamp("AREA", "lamp", POWER, (0, 0, HEIGHT), shape="DISK", size=2.0)
    check("disk", shown, disk(1.0), 0.01)  # a ring of 32 corners has the same power


def test_scaled_area():
    """The scale of the object counts: a square of 0.5 m, twice as large, is one of 1 m."""
    shown = plane()
    lamp = support.add_lamp("AREA", "lamp", POWER, (0, 0, HEIGHT), shape="SQUARE", size=0.5)
    lamp.scale = (2, 2, 2)
    half = 0.5  # four rectangles with a corner above the middle, side `half`: J. R. Howell, C-11
    root = math.sqrt(half ** 2 + HEIGHT ** 2)
    factor = 4 / (2 * math.pi) * 2 * half / root * math.atan(half / root)
    expected = math.pi * POWER / 4 * factor
    check("square", shown, expected)


def wide_lamp(height=HEIGHT):
    """A disk of 1 m radius, which hides a part of the sky and a sun above it."""
    return support.add_lamp("AREA", "lamp", POWER, (0, 0, height), shape="DISK", size=2.0)


def test_area_beside_sun():
    """The disk is between the sun and the plane. A lamp of Cycles blocks no light."""
    shown = plane()
    wide_lamp()
    support.add_lamp("SUN", "sun", 4.0, (0, 0, HEIGHT), angle=math.radians(0.5))
    check("disk and sun", shown, disk(1.0) + 4.0)


def test_area_beside_sky():
    """Occlusion in the same bake sees no lamp either."""
    shown = plane()
    bpy.context.scene.alpenglow.what = "BOTH"
    wide_lamp()
    support.set_world((1.0, 1.0, 1.0))
    check("disk and sky", shown, disk(1.0) + math.pi)
    assert occlusion_of_bake() == 1.0, occlusion_of_bake()


def occlusion_of_bake():
    """The darkest texel of the map."""
    image = next(i for i in bpy.data.images if i.get("alpenglow") == "occlusion")
    return float(numpy.array(image.pixels[:]).reshape(-1, 4)[:, 0].min())


def test_occlusion():
    """A bake of occlusion has no lamps in its file."""
    shown = plane()
    bpy.context.scene.alpenglow.what = "OCCLUSION"
    wide_lamp(0.2)
    support.add_lamp("POINT", "bulb", POWER, (0, 0, HEIGHT))
    support.bake()
    assert occlusion_of_bake() == 1.0, occlusion_of_bake()
    exporter = addon.export.Exporter(bpy.context, False, with_lamps=False)
    exporter.write(os.path.join(support.FOLDER, "occlusion.glb"))
    names = [n["name"] for n in exporter.writer.document["nodes"]]
    assert names == [shown.name, "Camera"], names


def test_unread():
    """Portals and lamps that diffuse surfaces do not see light nothing; the rest costs a note."""
    shown = plane()
    wide_lamp().data.cycles.is_portal = True
    support.add_lamp("POINT", "glint", POWER, (0, 0, HEIGHT)).visible_diffuse = False
    support.set_world((0.5, 0.5, 0.5))
    check("portal", shown, math.pi * 0.5)
    assert sys.modules["alpenglow_blender.bake"].Current.notes == []
    shown = plane()
    wide_lamp().data.spread = math.radians(90)
    support.add_lamp("SUN", "sun", 1.0, (0, 0, HEIGHT)).data.cycles.cast_shadow = False
    support.add_lamp("POINT", "tree", POWER, (0, 0, HEIGHT)).data.use_nodes = True
    shown.visible_shadow = shown.visible_diffuse = False
    _, notes = support.bake()
    for start in ("lamp: the spread", "sun: a lamp without shadows", "tree: nodes of lamps",
                  "plane: Ray Visibility without Shadow", "plane: Ray Visibility without Diffuse"):
        assert sum(n.startswith(start) for n in notes) == 1, (start, notes)


def test_world():
    """E = pi L under an even sky."""
    shown = plane()
    support.set_world((0.2, 0.3, 0.4))
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 2.0
    check("world", shown, math.pi * 0.6)


def test_picture():
    """A sky with one bright patch lights planes that face four ways as in Cycles."""
    sky = bpy.data.images.new("sky", 64, 32, float_buffer=True)
    pixels = numpy.full((32, 64, 4), 0.1, numpy.float32)
    pixels[18:22, 40:46, :3] = 20.0
    sky.pixels.foreach_set(pixels.ravel())
    sky.filepath_raw, sky.file_format = os.path.join(support.FOLDER, "sky.hdr"), "HDR"
    sky.save()
    for turn in range(4):
        shown = plane()
        world = bpy.data.worlds.new("World")
        world.use_nodes = True
        node = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = bpy.data.images.load(os.path.join(support.FOLDER, "sky.hdr"))
        background = world.node_tree.nodes["Background"]
        world.node_tree.links.new(node.outputs["Color"], background.inputs["Color"])
        background.inputs["Strength"].default_value = 1.5
        bpy.context.scene.world = world
        pivot = bpy.data.objects.new("pivot", None)
        bpy.context.scene.collection.objects.link(pivot)
        for o in (shown, bpy.context.scene.camera):
            o.parent = pivot
        pivot.rotation_euler = (0, math.radians(80), math.radians(90 * turn + 20))
        cycles, ours = irradiance_by_cycles(), irradiance_of_bake(shown)
        print(f"sky, {90 * turn} degrees: Cycles {cycles:.4f}, bake {ours:.4f}")
        assert support.close(cycles, ours, 0.03)  # of it .01 is Cycles' noise, .01 RGBE


def test_file():
    """Axes and lamps of the written .glb: Blender's +Z is glTF's +Y, a lamp shines along -Z."""
    plane()
    sun = support.add_lamp("SUN", "sun", 4.0, (1, 2, 3), color=(1, 0.5, 0))
    sun.rotation_euler = (0, 0, 0)
    support.add_lamp("POINT", "dark", -5.0, (0, 0, 1))
    path = os.path.join(support.FOLDER, "axes.glb")
    exporter = addon.export.Exporter(bpy.context, False)
    exporter.write(path)
    assert exporter.notes == ["dark takes light away, which no bake does: left out"]
    with open(path, "rb") as file:
        data = file.read()
    size = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20:20 + size].decode())
    node = next(n for n in document["nodes"] if n["name"] == "sun")
    matrix = numpy.array(node["matrix"]).reshape(4, 4).T
    assert numpy.allclose(matrix[:3, 3], (1, 3, -2)) and numpy.allclose(matrix[:3, 2], (0, 1, 0))
    light = document["extensions"]["KHR_lights_punctual"]["lights"][0]
    assert light == {"name": "sun", "type": "directional", "intensity": 4.0, "color": [1, 0.5, 0]}
    ran = subprocess.run(["alpenglow", "info", path], capture_output=True, text=True, check=True)
    assert "warning" not in ran.stdout + ran.stderr, ran.stdout + ran.stderr


support.main(test_formulas, test_point, test_spot, test_sun, test_area, test_scaled_area,
             test_area_beside_sun, test_area_beside_sky, test_occlusion, test_unread, test_world,
             test_picture, test_file)
