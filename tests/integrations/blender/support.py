# SPDX-License-Identifier: MIT
"""Scenes and measurements that tests of the add-on share. Runs inside Blender."""

import importlib
import math
import os
import subprocess
import sys
import traceback

import bpy
import numpy

FOLDER = os.environ["ALPENGLOW_TEST_FOLDER"]
MODULE = "alpenglow_blender"


def install():
    """Installs the add-on from its zip, as the preferences do, and returns its module."""
    bpy.ops.preferences.addon_install(filepath=os.path.join(FOLDER, "alpenglow-blender.zip"))
    bpy.ops.preferences.addon_enable(module=MODULE)
    for part in ("apply", "bake", "cut", "export", "glb", "lamps", "nodes", "run", "surface"):
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
    """What a screen shows of a picture, in sRGB. White is what 1 % of the pixels of `like`
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
    """Everything that a cancelled bake may not change."""
    return sorted((o.name, o.type, o.hide_render, o.data.name if o.data else "",
                   tuple(u.name for u in getattr(o.data, "uv_layers", ())),
                   len(getattr(o.data, "polygons", ())),
                   tuple(s.material.name if s.material else "" for s in o.material_slots))
                  for o in bpy.data.objects) + \
        sorted((m.name, len(m.node_tree.nodes) if m.node_tree else 0)
               for m in bpy.data.materials) + \
        sorted((i.name,) for i in bpy.data.images)


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
