# SPDX-License-Identifier: MIT
"""The button in a window: Blender draws into a virtual screen, and the bake runs behind the window.
Cancel ends it. One step of undo takes a finished bake back. The command ends with Blender."""

import os
import sys
import time
import traceback

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()
Current = addon.bake.Current


def in_view():
    """The context of the sidebar, in which a button runs."""
    window = bpy.context.window_manager.windows[0]
    area = next(a for a in window.screen.areas if a.type == "VIEW_3D")
    area.spaces[0].show_region_ui = True
    region = next(r for r in area.regions if r.type == "UI")
    return bpy.context.temp_override(window=window, area=area, region=region)


def press(operator):
    with in_view():
        return operator("INVOKE_DEFAULT", True)


def undo():
    with in_view():
        return bpy.ops.ed.undo()


def scene():
    settings = support.empty_scene()
    support.add_mesh("monkey", "monkey", support.add_material("m", (0.8, 0.2, 0.2)))
    support.add_mesh("plane", "floor", size=6, location=(0, 0, -1))
    support.add_mesh("plane", "line", location=(0, 0, 2)).scale.x = 0
    support.add_lamp("POINT", "lamp", 100, (2, 0, 3))
    bpy.ops.ed.undo_push(message="scene")
    return settings


def test():
    """A generator: at each yield Blender draws and handles events."""
    settings = scene()
    settings.size, settings.stop, settings.error = 512, "ERROR", 0.05
    before = support.state_of_scene()
    assert press(bpy.ops.alpenglow.bake) == {"RUNNING_MODAL"}
    assert not bpy.ops.alpenglow.bake.poll(), "a second bake beside the first"
    while Current.bake is not None and "light" not in Current.bake.job.stage:
        yield
    job = Current.bake.job
    assert Current.notes and Current.notes[0].startswith("line has no area"), "notes of the export"
    print(f"  {job.describe()}")
    assert press(bpy.ops.alpenglow.cancel) == {"FINISHED"}
    while Current.bake is not None:
        yield
    assert job.process.returncode == 130 and "cancelled" in Current.message, Current.message
    support.check_state(before)
    print("ok cancel", flush=True)

    settings.size, settings.error = 64, 4
    bpy.ops.ed.undo_push(message="settings")
    before = support.state_of_scene()
    assert press(bpy.ops.alpenglow.bake) == {"RUNNING_MODAL"}
    while Current.bake is not None:
        yield
    yield
    print(f"  {Current.message}")
    assert "Alpenglow" in bpy.data.objects["floor"].data.uv_layers, Current.message
    assert undo() == {"FINISHED"}
    yield
    support.check_state(before)
    print("ok bake and undo", flush=True)

    settings = bpy.context.scene.alpenglow
    settings.size, settings.error = 512, 0.05
    assert press(bpy.ops.alpenglow.bake) == {"RUNNING_MODAL"}
    yield
    with open(os.path.join(support.FOLDER, "child.pid"), "w", encoding="utf-8") as file:
        file.write(str(Current.bake.job.process.pid))
    with in_view():
        bpy.ops.wm.quit_blender()  # run.sh sees whether the command ends with it
    yield


steps = test()
deadline = time.monotonic() + 120


def step():
    status = 0
    try:
        assert time.monotonic() < deadline, f"two minutes went by: {Current.message}"
        next(steps)
        return 0.1
    except StopIteration:
        pass
    except Exception:  # pylint: disable=broad-except
        traceback.print_exc()
        status = 1
    sys.stdout.flush()
    if Current.bake is not None:
        Current.bake.cancel()
    os._exit(status)


bpy.app.timers.register(step, first_interval=1)
