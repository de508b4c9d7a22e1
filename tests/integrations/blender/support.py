# SPDX-License-Identifier: MIT
"""Scenes and measurements that tests of the add-on share. Runs inside Blender."""

import importlib
import math
import os
import subprocess
import sys
import traceback
import zlib

import bpy
import numpy

FOLDER = os.environ["ALPENGLOW_TEST_FOLDER"]
MODULE = "alpenglow_blender"


def install():
    """Installs the add-on from its zip, as the preferences do, and returns its module."""
    bpy.ops.preferences.addon_install(filepath=os.path.join(FOLDER, "alpenglow-blender.zip"))
    bpy.ops.preferences.addon_enable(module=MODULE)
    for part in ("apply", "bake", "copies", "cut", "export", "folders", "glb", "lamps", "nodes",
                 "place", "presence", "probes", "removal", "repair", "run", "surface", "uv"):
        importlib.import_module(f"{MODULE}.{part}")
    return sys.modules[MODULE]


def empty_scene():
    for collection in (bpy.data.objects, bpy.data.meshes, bpy.data.materials, bpy.data.images,
                       bpy.data.lights, bpy.data.cameras, bpy.data.collections,
                       bpy.data.node_groups, bpy.data.worlds):
        for element in list(collection):
            if element.name != "Render Result":
                collection.remove(element)
    settings = bpy.context.scene.alpenglow
    settings.what, settings.scope, settings.size = "LIGHT", "VISIBLE", 64
    settings.stop, settings.quality = "QUALITY", "PREVIEW"
    return settings


def add_material(name, colour, emission=0.0):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    principled = material.node_tree.nodes["Principled BSDF"]
    principled.inputs["Base Color"].default_value = (*colour, 1)
    if emission:
        emitted = sys.modules[f"{MODULE}.surface"].first_input(
            principled, "Emission Color", "Emission")
        emitted.default_value = (*colour, 1)
        principled.inputs["Emission Strength"].default_value = emission
    return material


def add_mesh(operator, name, material=None, **options):
    getattr(bpy.ops.mesh, f"primitive_{operator}_add")(**options)
    added = bpy.context.object
    added.name = name
    if material is not None:
        added.data.materials.append(material)
    return added


def add_lamp(kind, name, energy, location, **properties):
    lamp = bpy.data.lights.new(name, kind)
    lamp.energy = energy
    for key, value in properties.items():
        setattr(lamp, key, value)
    added = bpy.data.objects.new(name, lamp)
    added.location = location
    bpy.context.scene.collection.objects.link(added)
    return added


def floor_and_lamp():
    """A new scene with the grey mesh "floor", 8 m wide, and a point lamp. Returns the settings."""
    settings = empty_scene()
    add_mesh("plane", "floor", add_material("grey", (0.6, 0.6, 0.6)), size=8)
    add_lamp("POINT", "lamp", 200, (2, -2, 4))
    return settings


def add_camera(location, target, width=320, height=240):
    """The camera of the scene. The size of the picture is a part of its field of view."""
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.scene.collection.objects.link(camera)
    camera.location = location
    towards = camera.location.copy()
    towards.xyz = [t - p for t, p in zip(target, location)]
    camera.rotation_mode = "QUATERNION"
    camera.rotation_quaternion = towards.to_track_quat("-Z", "Y")
    bpy.context.scene.camera = camera
    return camera


def set_world(colour):
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (*colour, 1)
    bpy.context.scene.world = world


def bake():
    """Bakes by the operator. Returns its message and notes."""
    result = bpy.ops.alpenglow.bake()
    current = sys.modules[f"{MODULE}.bake"].Current
    assert result == {"FINISHED"}, current.message
    return current.message, current.notes


def bake_in(folder):
    """Bakes by the parts of the operator, so that the files of the command stay in `folder`."""
    addon = sys.modules[MODULE]
    exporter = addon.export.Exporter(bpy.context, False)
    scene, out = os.path.join(folder, "scene.glb"), os.path.join(folder, "baked.glb")
    exporter.write(scene)
    options = addon.bake.options_of(bpy.context.scene.alpenglow) + exporter.scene_options(folder)
    subprocess.run(["alpenglow", "bake", scene, "-o", out, "-f", "-q"] + options, check=True)
    applier = addon.apply.Applier(bpy.context, exporter.items, addon.apply.Result(out))
    applier.apply()
    return out, exporter.notes + applier.notes


def render_cycles(samples=1):
    """Linear radiance [height][width][3] by Cycles, the first row on top. One sample goes through
    the middle of a pixel."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = samples, False
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.pixel_filter_type = "GAUSSIAN"
    scene.cycles.filter_width = 0.01
    scene.view_settings.view_transform = "Raw"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = os.path.join(FOLDER, "cycles.exr")
    bpy.ops.render.render(write_still=True)
    return read_exr(scene.render.filepath)


def render_command(baked, *options):
    """The same by `alpenglow render --with lightmap`."""
    out = os.path.join(FOLDER, "command.exr")
    render = bpy.context.scene.render
    size = f"{render.resolution_x}x{render.resolution_y}"
    method = [] if "--with" in options else ["--with", "lightmap"]
    subprocess.run(["alpenglow", "render", baked, "-o", out, "-f", "-q", *method, "--samples", "1",
                    "--camera", "0", "--resolution", size, *options], check=True)
    return read_exr(out)


def read_exr(path):
    image = bpy.data.images.load(path, check_existing=False)
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = numpy.empty(width * height * image.channels, numpy.float32)
    image.pixels.foreach_get(pixels)
    channels = image.channels
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, channels)[::-1, :, :3]


def exposed(picture, like):
    """A picture as a screen shows it, in sRGB. White is what 1 % of the pixels of `like`
    exceed."""
    white = numpy.quantile(like.max(axis=2), 0.99)
    assert white > 0, "a black picture"
    x = numpy.clip(picture / white, 0, 1)
    return numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def close_share(a, b):
    """Share of pixels whose channels differ by at most 1/255 on a screen."""
    return float((numpy.abs(exposed(a, b) - exposed(b, b)) <= 1 / 255).all(axis=2).mean())


def unseen_shares(picture):
    """Shares of pixels that a screen shows as white in some channel, and as black in all."""
    shown = exposed(picture, picture)
    white, black = (shown >= 1 - 1e-5).any(axis=2), (shown <= 0.5 / 255).all(axis=2)
    return float(white.mean()), float(black.mean())


def state_of_scene():
    """Everything that a cancelled bake may not change, as lines that can be compared."""
    bpy.context.view_layer.update()
    return sorted([state_of_object(o) for o in bpy.data.objects] +
                  [state_of_mesh(m) for m in bpy.data.meshes] +
                  [state_of_material(m) for m in bpy.data.materials] +
                  [f"image {i.name}" for i in bpy.data.images] +
                  [f"group {g.name}" for g in bpy.data.node_groups])


def check_state(before):
    """Fails if the scene differs from `before`, with the lines that do."""
    after = state_of_scene()
    lines = sorted(set(before) ^ set(after))
    assert after == before, "\n".join(lines)


def plain(value):
    """A value of a property as something whose text does not depend on addresses."""
    if hasattr(value, "name_full"):
        return value.name_full
    if isinstance(value, str) or not hasattr(value, "__len__"):
        return value if isinstance(value, (str, bool, int, float)) else str(type(value))
    return [plain(v) for v in value]


def properties_of(owner):
    return {k: plain(v) for k, v in sorted(owner.items()) if k != "cycles"}


def state_of_object(o):
    data = o.data.name if o.data else ""
    slots = [(s.link, s.material.name if s.material else "") for s in o.material_slots]
    hidden = (o.hide_render, o.hide_viewport, o.hide_get())
    place = [round(x, 5) for row in o.matrix_world for x in row]
    modifiers = [(m.name, m.type, m.show_viewport, m.show_render) for m in o.modifiers]
    owners = (o.parent.name if o.parent else "", sorted(c.name for c in o.users_collection))
    return f"object {(o.name, o.type, data, slots, hidden, place, modifiers, owners)} " \
           f"{properties_of(o)}"


def state_of_mesh(mesh):
    numbers = [numpy.array([x for v in mesh.vertices for x in v.co], numpy.float32),
               numpy.array([l.vertex_index for l in mesh.loops]),
               numpy.array([(p.loop_start, p.material_index, p.use_smooth)
                            for p in mesh.polygons])]
    layers = [(u.name, u.active, u.active_render) for u in mesh.uv_layers]
    numbers += [numpy.array([x for d in u.data for x in d.uv]) for u in mesh.uv_layers]
    checksum = zlib.crc32(b"".join(a.tobytes() for a in numbers))
    materials = [m.name if m else "" for m in mesh.materials]
    normals = (mesh.use_auto_smooth, round(mesh.auto_smooth_angle, 5), mesh.has_custom_normals)
    return f"mesh {(mesh.name, layers, checksum, materials, normals)} {properties_of(mesh)}"


def state_of_material(material):
    tree = material.node_tree
    nodes = [(n.name, n.type, n.mute, [plain(getattr(s, "default_value", "")) for s in n.inputs],
              properties_of(n)) for n in tree.nodes] if tree else []
    links = [(l.from_node.name, l.from_socket.identifier, l.to_node.name, l.to_socket.identifier,
              l.is_muted) for l in tree.links] if tree else []
    state = (material.name, material.use_nodes, sorted(map(str, nodes)), sorted(links))
    return f"material {state} {properties_of(material)}"


def close(a, b, tolerance):
    return math.isclose(a, b, rel_tol=tolerance, abs_tol=1e-12)


def main(*tests):
    """Runs tests; a failure ends Blender with 1."""
    failed = 0
    for test in tests:
        try:
            test()
            print(f"ok {test.__name__}", flush=True)
        except Exception:  # pylint: disable=broad-except
            traceback.print_exc()
            print(f"FAILED {test.__name__}", flush=True)
            failed += 1
    sys.stdout.flush()
    os._exit(1 if failed else 0)
