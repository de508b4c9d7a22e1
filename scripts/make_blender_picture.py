# SPDX-License-Identifier: MIT
"""Inside Blender, by make_blender_picture.sh: loads a scene, bakes it with the add-on, and saves a
picture of the window. blender ... --python make_blender_picture.py -- SCENE.glb OUT.png"""

import os
import sys
import traceback

import bpy
import numpy

SCENE, OUT = sys.argv[-2:]
TAB = (13, 230)  # of the add-on, in the sidebar: pixels from the right and the top of the view
numpy.bool = bool  # Blender 3.4's importer of glTF needs a name that numpy 1.24 lacks


def load():
    bpy.context.preferences.view.show_splash = False
    bpy.ops.preferences.addon_enable(module="alpenglow_blender")
    for o in list(bpy.data.objects):
        bpy.data.objects.remove(o)
    bpy.ops.import_scene.gltf(filepath=SCENE)
    bpy.ops.object.select_all(action="DESELECT")


def light_up():
    """Adds a sky of daylight and a sun."""
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.45, 0.6, 1.0, 1)
    background.inputs["Strength"].default_value = 0.8
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.data.color = 5, (1, 0.93, 0.82)
    sun.rotation_euler = (0.5, 0.35, 0)
    bpy.context.scene.collection.objects.link(sun)


def view():
    window = bpy.context.window_manager.windows[0]
    area = next(a for a in window.screen.areas if a.type == "VIEW_3D")
    return window, area


def show_view():
    window, area = view()
    space = area.spaces[0]
    space.show_region_ui, space.show_region_toolbar = True, False
    space.shading.type = "MATERIAL"
    space.overlay.show_overlays = space.show_gizmo = False
    camera = next((o for o in bpy.data.objects if o.type == "CAMERA"), None)
    if camera is not None:
        bpy.context.scene.camera = camera
        space.region_3d.view_perspective = "CAMERA"
        space.region_3d.view_camera_zoom = 18
        camera.data.show_passepartout = False


def save_picture(window, area):
    """The view alone, with 64 levels a channel: a picture of less than 300 KB."""
    with bpy.context.temp_override(window=window, area=area):
        bpy.ops.screen.screenshot_area(filepath=OUT)
    scene, picture = bpy.context.scene, bpy.data.images.load(OUT)
    pixels = numpy.array(picture.pixels[:], numpy.float32)
    picture.pixels.foreach_set(numpy.round(pixels * 63) / 63)
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.compression = 100
    picture.save_render(OUT, scene=scene)


def steps():
    """At each yield Blender draws and handles events."""
    load()
    light_up()
    show_view()
    yield
    window, area = view()
    place = {"x": area.x + area.width - TAB[0], "y": area.y + area.height - TAB[1]}
    middle = {"x": area.x + area.width // 3, "y": area.y + area.height // 2}
    for kind, value, at in (("ESC", "PRESS", middle), ("ESC", "RELEASE", middle),
                            ("MOUSEMOVE", "NOTHING", place), ("LEFTMOUSE", "PRESS", place),
                            ("LEFTMOUSE", "RELEASE", place), ("MOUSEMOVE", "NOTHING", middle)):
        window.event_simulate(type=kind, value=value, **at)
        yield
    settings = bpy.context.scene.alpenglow
    settings.what, settings.quality, settings.size = "LIGHT", "MEDIUM", 1024
    with bpy.context.temp_override(window=window, area=area):
        bpy.ops.alpenglow.bake("INVOKE_DEFAULT", True)
    current = sys.modules["alpenglow_blender.bake"].Current
    while current.bake is not None:
        yield
    print(current.message, current.notes)
    for _ in range(30):
        yield
    save_picture(window, area)


running = steps()


def step():
    status = 0
    try:
        next(running)
        return 0.2
    except StopIteration:
        pass
    except Exception:  # pylint: disable=broad-except
        traceback.print_exc()
        status = 1
    sys.stdout.flush()
    os._exit(status)


bpy.app.timers.register(step, first_interval=1)
