# SPDX-License-Identifier: MIT
"""Broken installs, failures and cancels give one clear line each, and change nothing."""

import os
import signal
import sys
import threading
import time

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()
TEMP = os.environ["TMPDIR"]


def script(name, text, mode=0o755):
    path = os.path.join(support.FOLDER, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write("#!/bin/sh\n" + text)
    os.chmod(path, mode)
    return path


def scene():
    settings = support.empty_scene()
    support.add_mesh("monkey", "monkey", support.add_material("m", (0.8, 0.2, 0.2)))
    support.add_mesh("plane", "floor", size=6)
    support.add_lamp("POINT", "lamp", 100, (2, 0, 3))
    return settings


def left_over():
    return sorted(n for n in os.listdir(TEMP) if n.startswith("alpenglow-"))


def refusal(command):
    """The line of a bake that cannot start; the scene must be as before."""
    before = support.state_of_scene()
    bake = addon.bake.Bake(bpy.context, bpy.context.scene.alpenglow, command)
    bake.wait(bpy.context)
    assert bake.state == addon.bake.FAILED, bake.state
    assert support.state_of_scene() == before and not left_over()
    assert "\n" not in bake.message
    print(f"  {bake.message}")
    return bake.message


def test_broken_installs():
    scene()
    assert "there is no such file; name the command" in refusal("/nowhere/alpenglow")
    assert "is not executable" in refusal(script("plain", "", 0o644))
    assert "is version 0.0.9, and this add-on needs 0.1" in refusal(
        script("old", "echo alpenglow 0.0.9"))
    assert "is version 0.2.0" in refusal(script("new", "echo alpenglow 0.2.0"))
    assert "is another program" in refusal(script("other", "echo GNU true 9.1"))
    assert "crashed (SIGSEGV)" in refusal(script("crash", "kill -SEGV $$"))
    assert "ended with 127: " in refusal(script("library", "echo no libembree3.so >&2; exit 127"))
    not_a_program = script("text", "")
    with open(not_a_program, "wb") as file:
        file.write(b"\x7fELF broken")
    assert "cannot be started" in refusal(not_a_program)
    path = os.environ["PATH"]
    os.environ["PATH"] = "/nonexistent"
    assert "there is no command alpenglow on PATH" in refusal("")
    os.environ["PATH"] = path
    line, works = addon.preferences.check("")
    assert works and line.startswith("alpenglow 0.1"), line


def test_failing_bakes():
    scene()
    version = "if [ $1 = --version ]; then echo alpenglow 0.1.0; exit; fi\n"
    assert "crashed (SIGSEGV)" in refusal(script("late", version + "kill -SEGV $$"))
    full = "echo 'alpenglow: OUT: disk full; free some' >&2; echo more >&2; exit 1"
    assert refusal(script("full", version + full)) == \
        "OUT: disk full; free some"
    assert "ended well and wrote no baked.glb" in refusal(script("nothing", version + "exit 0"))
    assert "not a .glb" in refusal(script("junk", version + 'echo 12345678901234567890 >"$4"'))
    bpy.data.objects.remove(bpy.data.objects["lamp"])
    assert refusal("").startswith("nothing lights the scene: no lamp shines")


def long_bake():
    settings = scene()
    settings.size, settings.stop, settings.error = 2048, "ERROR", 0.01
    return addon.bake.Bake(bpy.context, settings, "")


def test_cancel():
    before = None
    bake = long_bake()
    before = support.state_of_scene()
    deadline = time.monotonic() + 60
    while bake.step(bpy.context) == addon.bake.RUNNING and bake.job.share == 0:
        assert time.monotonic() < deadline, "no progress within a minute"
        time.sleep(0.05)
    print(f"  {bake.job.describe()}")
    assert bake.state == addon.bake.RUNNING and bake.job.stage != "starting" and left_over()
    bake.cancel()
    assert bake.state == addon.bake.CANCELLED and bake.job.process.returncode == 130
    assert bake.step(bpy.context) == addon.bake.CANCELLED
    assert support.state_of_scene() == before and not left_over()


def test_deaf_child():
    """A child that ignores the interrupt is killed."""
    addon.run.PATIENCE = 0.5
    job = addon.run.Job([script("deaf", "trap '' INT; while :; do sleep 0.1; done")])
    time.sleep(0.3)
    job.cancel()
    assert job.process.returncode == -signal.SIGKILL and job.poll()
    addon.run.PATIENCE = 10.0


def test_interrupt():
    """Ctrl-C ends a bake of a script."""
    bake = long_bake()
    before = support.state_of_scene()
    threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    assert bake.wait(bpy.context) == addon.bake.CANCELLED, bake.message
    assert bake.job.process.returncode == 130
    assert support.state_of_scene() == before and not left_over()


def test_changed_scene():
    """Objects that the user changes or removes during a bake cost a line each."""
    settings = scene()
    settings.size = 64
    support.add_mesh("cube", "gone", size=1)
    bake = addon.bake.Bake(bpy.context, settings, "")
    bpy.data.objects.remove(bpy.data.objects["gone"])
    mesh = bpy.data.meshes.new("other")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    bpy.data.objects["monkey"].data = mesh
    assert bake.wait(bpy.context) == addon.bake.DONE, bake.message
    assert "gone was removed during the bake" in bake.notes
    assert "monkey changed during the bake; bake again" in bake.notes
    assert "Alpenglow" in bpy.data.objects["floor"].data.uv_layers


def test_fault_of_ours():
    """An error that nobody expected ends the bake, and leaves a step to undo."""
    scene().size = 64
    whole = addon.nodes.show_light
    addon.nodes.show_light = None
    try:
        bpy.ops.alpenglow.bake()
        raise AssertionError("no error")
    except RuntimeError as error:
        assert "the add-on failed: TypeError: " in str(error) and "undo this step" in str(error)
    finally:
        addon.nodes.show_light = whole
    assert not left_over() and addon.bake.Current.bake is None


support.main(test_broken_installs, test_failing_bakes, test_cancel, test_deaf_child, test_interrupt,
             test_changed_scene, test_fault_of_ours)
