# SPDX-License-Identifier: MIT
"""Broken installs, failures and cancels give one clear line each, and change nothing."""

import os
import signal
import struct
import subprocess
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
    support.check_state(before)
    assert not left_over()
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
    addon.run.CHECK_SECONDS = 0.3
    assert "no answer within 0.3 s" in refusal(script("slow", "exec sleep 60"))
    addon.run.CHECK_SECONDS = 5
    not_a_program = script("text", "")
    with open(not_a_program, "wb") as file:
        file.write(b"\x7fELF broken")
    assert "cannot be started" in refusal(not_a_program)
    path = os.environ["PATH"]
    os.environ["PATH"] = "/nonexistent"
    assert refusal("").startswith("there is no command alpenglow on PATH")
    assert refusal("alpenglow").startswith("there is no command alpenglow on PATH")
    os.environ["PATH"] = path
    line, works = addon.preferences.check("")
    assert works and line.startswith("alpenglow 0.1"), line
    assert addon.preferences.check("alpenglow") == (line, True)
    assert addon.preferences.check(os.path.expanduser("~")) == (
        os.path.expanduser("~") + ": is a folder; name the command alpenglow itself in the "
        "preferences of the add-on", False)


def test_failing_bakes():
    scene()
    version = "if [ $1 = --version ]; then echo alpenglow 0.1.0; exit; fi\n"
    assert "crashed (SIGSEGV)" in refusal(script("late", version + "kill -SEGV $$"))
    full = "echo 'alpenglow: OUT: disk full; free some' >&2; echo more >&2; exit 1"
    assert refusal(script("full", version + full)) == \
        "OUT: disk full; free some"
    assert "ended well and wrote no baked.glb" in refusal(script("nothing", version + "exit 0"))
    assert "not a .glb" in refusal(script("junk", version + 'echo 12345678901234567890 >"$4"'))


def add_sky(kind):
    """A world whose sky is a texture."""
    support.set_world((0, 0, 0))
    tree = bpy.context.scene.world.node_tree
    sky = tree.nodes.new(kind)
    tree.links.new(sky.outputs[0], tree.nodes["Background"].inputs["Color"])
    return sky


def test_darkness():
    """Without light the message names a remedy that Blender has."""
    scene()
    bpy.data.objects.remove(bpy.data.objects["lamp"])
    for what in ("LIGHT", "PROBES"):
        bpy.context.scene.alpenglow.what = what
        if what == "PROBES":
            bpy.ops.wm.save_as_mainfile(filepath=os.path.join(support.FOLDER, "dark.blend"))
        assert refusal("") == "nothing lights the scene: no lamp shines, no material emits and " \
            "the World is black; add a lamp, or give the World a colour"
    bpy.context.scene.alpenglow.what = "LIGHT"
    remedy = "; use an Environment Texture with an .exr or .hdr image, or add a lamp"
    for kind, fault in (("ShaderNodeTexSky", "Sky Texture is not read"),
                        ("ShaderNodeTexEnvironment", "Environment Texture has no image")):
        add_sky(kind)
        name = bpy.context.scene.world.name
        assert refusal("") == f"nothing lights the scene: world {name}: {fault}; the sky is " \
            f"black{remedy}"
    support.add_lamp("POINT", "lamp", 100, (2, 0, 3))
    _, notes = support.bake()
    assert f"world {name}: Environment Texture has no image; the sky is black" in notes, notes


def test_temporary_folder():
    """Files lie in the folder of the preferences. A full disk names the remedy."""
    scene()
    files = bpy.context.preferences.filepaths
    place = os.path.join(support.FOLDER, "elsewhere")
    os.mkdir(place)
    before, files.temporary_directory = files.temporary_directory, place
    try:
        bake = addon.bake.Bake(bpy.context, bpy.context.scene.alpenglow, "")
        assert os.path.dirname(bake.folder.path) == place, bake.folder.path
        assert bake.wait(bpy.context) == addon.bake.DONE, bake.message
        assert [n for n in os.listdir(place) if n.startswith("alpenglow-")] == []
    finally:
        files.temporary_directory = before
    remedy = "No space left on device; free some of that disk, or choose another folder in " \
        "Preferences > File Paths > Temporary Files"
    whole = addon.export.Exporter.write
    addon.export.Exporter.write = lambda self, path: (os.symlink("/dev/full", path),
                                                      whole(self, path))
    try:
        message = refusal("")
        assert message.startswith(os.path.join(TEMP, "alpenglow-bake-")), message
        assert message.endswith(f": {remedy}"), message
    finally:
        addon.export.Exporter.write = whole
    version = "if [ $1 = --version ]; then echo alpenglow 0.1.0; exit; fi\n"
    full = "echo 'alpenglow: OUT: cannot write: No space left on device' >&2; exit 1"
    assert refusal(script("disk", version + full)) == f"OUT: cannot write: {remedy}"


def write_glb(document, binary=b""):
    """A .glb of any JSON. Returns its path."""
    path = os.path.join(support.FOLDER, "broken.glb")
    document += b" " * (-len(document) % 4)
    with open(path, "wb") as file:
        file.write(b"glTF" + struct.pack("<II", 2, 28 + len(document) + len(binary)))
        file.write(struct.pack("<I4s", len(document), b"JSON") + document)
        file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)
    return path


def test_broken_results():
    """Files that the command did not finish, or that are none of its own."""
    faults = {b"{broken": "its JSON is broken", b"\xff": "its JSON is broken",
              b"[1]": "has no JSON object", b'{"nodes":[1]}': "nodes: "}
    for document, fault in faults.items():
        try:
            addon.apply.Result(write_glb(document))
            raise AssertionError(document)
        except addon.glb.GlbError as error:
            assert fault in str(error) and "broken.glb: " in str(error), error
    view, count, kind = '{"buffer":0,"byteLength":%s}', '"count":%s', '"componentType":%s'
    for numbers in ((12, -1, 5126), (12, 4, 5126), (12, "1e9", 5126), (12, 10 ** 18, 5126),
                    (99, 1, 5126), (-4, 1, 5126), ('"x"', 1, 5126), (12, 1, 7), (12, "[]", 5126)):
        text = f'{{"bufferViews":[{view}],"accessors":[{{"bufferView":0,"type":"VEC3",' \
               f'{count},{kind}}}]}}' % numbers
        try:
            addon.glb.Reader(write_glb(text.encode(), bytes(12))).accessor(0)
            raise AssertionError(text)
        except addon.glb.GlbError as error:
            assert "accessor 0: " in str(error) or "buffer view 0: " in str(error), error


def test_cut_result():
    """Each prefix of a result costs one line, and the scene stays."""
    scene().size = 64
    out, _ = support.bake_in(support.FOLDER)
    with open(out, "rb") as file:
        whole = file.read()
    scene().size = 64
    version = "if [ $1 = --version ]; then echo alpenglow 0.1.0; exit; fi\n"
    cut = os.path.join(support.FOLDER, "cut.glb")
    for size in (19, 21, 200, len(whole) // 2, len(whole) - 1):
        with open(cut, "wb") as file:
            file.write(whole[:size])
        message = refusal(script("cutter", version + f'cp {cut} "$4"'))
        assert "the add-on failed" not in message, message


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
    support.check_state(before)
    assert not left_over()


def test_deaf_child():
    """A child that ignores the interrupt is killed."""
    addon.run.PATIENCE = 0.5
    job = addon.run.Job([script("deaf", "trap '' INT; while :; do sleep 0.1; done")])
    time.sleep(0.3)
    job.cancel()
    assert job.process.returncode == -signal.SIGKILL and job.poll()
    addon.run.PATIENCE = 10.0


def test_interrupt_without_waiting():
    """Cancel of the panel returns at once; poll() kills a child that does not heed it."""
    addon.run.PATIENCE = 0.5
    job = addon.run.Job([script("deaf", "trap '' INT; while :; do sleep 0.1; done")])
    time.sleep(0.3)
    began = time.monotonic()
    job.interrupt()
    assert time.monotonic() - began < 0.2 and not job.poll()
    assert job.describe() == "ending the command"
    while not job.poll():
        assert time.monotonic() - began < 5, "the deaf child lives on"
        time.sleep(0.05)
    assert job.process.returncode == -signal.SIGKILL
    addon.run.PATIENCE = 10.0


def test_killed_blender():
    """The command ends with a killed Blender. The next bake removes the folder left over."""
    pid_file = os.path.join(support.FOLDER, "killed.pid")
    version = "if [ $1 = --version ]; then echo alpenglow 0.1.0; exit; fi\n"
    silent = script("silent", version + "exec sleep 300")  # no write to a broken pipe ends it
    here = os.path.dirname(os.path.abspath(__file__))
    with subprocess.Popen([bpy.app.binary_path, "-b", "--factory-startup", "--python",
                           os.path.join(here, "killed.py"), "--", silent, pid_file],
                          stdout=subprocess.DEVNULL) as blender:
        deadline = time.monotonic() + 60
        while not os.path.exists(pid_file):
            assert time.monotonic() < deadline and blender.poll() is None, "no bake began"
            time.sleep(0.05)
        with open(pid_file, encoding="utf-8") as file:
            child = int(file.read())
        assert is_running(child) and left_over()
        blender.kill()
    while is_running(child):
        assert time.monotonic() < deadline, "the command runs on"
        time.sleep(0.05)
    own = addon.folders.Folder()
    assert left_over() == [os.path.basename(own.path)], left_over()
    second = addon.folders.Folder()  # the lock keeps the first
    assert len(left_over()) == 2
    own.remove()
    second.remove()
    assert not left_over()


def is_running(pid):
    try:
        with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_relative_command():
    """A path that begins with // is in the folder of the .blend."""
    scene()
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(support.FOLDER, "relative.blend"))
    script("mine", "echo alpenglow 0.1.7")
    assert addon.run.check_command("//mine")[1] == "0.1.7"


def test_interrupt():
    """Ctrl-C ends a bake of a script."""
    bake = long_bake()
    before = support.state_of_scene()
    threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    assert bake.wait(bpy.context) == addon.bake.CANCELLED, bake.message
    assert bake.job.process.returncode == 130
    support.check_state(before)
    assert not left_over()


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


support.main(test_broken_installs, test_failing_bakes, test_darkness,
             test_temporary_folder, test_broken_results, test_cut_result,
             test_cancel, test_deaf_child, test_interrupt_without_waiting, test_killed_blender,
             test_interrupt, test_changed_scene, test_fault_of_ours, test_relative_command)
