# SPDX-License-Identifier: MIT
"""A bake from scene to result: export, command, apply. It touches the scene only at its end."""

import errno
import os
import time
import traceback

import bpy

from . import apply, export, folders, glb, place, probes, repair, run, world

RUNNING, DONE, FAILED, CANCELLED = "running", "done", "failed", "cancelled"
DARK = "nothing lights the scene: "  # a refusal of the command begins with it
FULL = os.strerror(errno.ENOSPC)
FAULTS = (run.CommandError, export.ExportError, apply.ApplyError, glb.GlbError, OSError)


def options_of(settings):
    """Options of the command for light, occlusion and their error."""
    options = []
    if settings.stop == "ERROR":
        options += ["--error", f"{settings.error:.6g}"]
    else:
        options += ["--quality", settings.quality.lower()]
    maps = [name for name, wanted in (("ao", settings.bakes_occlusion),
                                      ("light", settings.bakes_light)) if wanted]
    options += ["--maps", ",".join(maps), "--size", str(settings.size), "--atlas", "charts"]
    if settings.bakes_light:
        options += ["--lightmap-as", "extras", "--lightmap-format", "exr",
                    "--units", "irradiance/pi"]
    return options


class Bake:
    """start(), then step() until the state is not RUNNING; the last step applies the result."""

    def __init__(self, context, settings, command):
        self.state, self.message, self.notes, self.seconds = RUNNING, "", [], {}
        self.kind, self.folder, self.job, self.items = settings.what, None, None, []
        self.place, self.kept = None, None
        self.is_touched = False  # a failed bake left something behind in the scene
        self.began = time.monotonic()
        try:
            self._start(context, settings, command)
        except Exception as error:  # pylint: disable=broad-except
            self._fail(error)

    def _start(self, context, settings, command):
        path, _ = run.check_command(command)
        self.folder = folders.Folder()
        self.place = place.Place(context)
        repairs = repair.repair()
        self.is_touched = bool(repairs)
        exporter = export.Exporter(context, settings.scope == "SELECTED",
                                   settings.what != "OCCLUSION")
        scene = os.path.join(self.folder.path, "scene.glb")
        exporter.write(scene)
        self.out = os.path.join(self.folder.path, "baked.glb")
        if self.kind == "PROBES":
            self.out = probes.place(context)
            arguments = [path, "probes", scene, "-o", self.out, "-f"] + probes.options(settings)
            arguments += exporter.scene_options(self.folder.path)
        else:
            arguments = [path, "bake", scene, "-o", self.out] + options_of(settings)
            if settings.bakes_light:
                arguments += exporter.scene_options(self.folder.path)
            if exporter.has_kept_nodes():
                arguments += ["--only", f"*[!{export.KEPT_END}]"]
        self.items, self.notes = exporter.items, repairs + exporter.notes
        self._lap("export")
        self.job = run.Job(arguments + ["--progress", "json"])

    def _lap(self, name):
        now = time.monotonic()
        self.seconds[name], self.began = now - self.began, now

    def step(self, context):
        """Reads the progress of the command, and applies its result once it has ended."""
        if self.state == RUNNING and self.job.poll():
            if self.job.cancelled:
                self._end(CANCELLED, "the bake was cancelled; nothing changed")
                return self.state
            try:
                self._finish(context)
            except Exception as error:  # pylint: disable=broad-except
                self._fail(error)
        return self.state

    def wait(self, context):
        """Runs to the end."""
        if self.state == RUNNING:
            self.job.wait()
        return self.step(context)

    def _finish(self, context):
        self.job.check()
        self._lap("bake")
        self.notes += [self._plain(line) for line in self.job.warnings]
        if not os.path.isfile(self.out):
            name = os.path.basename(self.out)
            raise run.CommandError(f"the command ended well and wrote no {name}; install alpenglow "
                                   "again")
        result = None if self.kind == "PROBES" else apply.Result(self.out)
        message = self._apply(context, result)
        self._lap("apply")
        seconds = ", ".join(f"{name} {value:.1f} s" for name, value in self.seconds.items())
        self._end(DONE, f"{message} ({seconds})")

    def _apply(self, context, result):
        """Applies the result to the scene of the bake. A result that cannot be applied is kept."""
        try:
            override = self.place.override(context)
            if override is None:
                raise apply.ApplyError("the scene or the view layer was removed during the bake")
            self.place.current_keys(self.items)
            with override:
                if result is None:
                    count = probes.show(bpy.context, self.out)
                    return f"{count} {'probe is' if count == 1 else 'probes are'} in {self.out}"
                applier = apply.Applier(bpy.context, self.items, result)
                applier.apply()
        except Exception:
            self.kept = self.out if result is None else self.folder.keep(bpy.data.filepath)
            raise
        self.notes += applier.notes
        return "1 object is baked" if applier.count == 1 else f"{applier.count} objects are baked"

    def interrupt(self):
        """Tells the command to end. A later step() sees its end."""
        self.job.interrupt()

    def cancel(self):
        """Ends the command and waits for it. The scene is as it was."""
        if self.job is not None:
            self.job.cancel()
        if self.state == RUNNING:
            self._end(CANCELLED, "the bake was cancelled; nothing changed")

    def _fail(self, error):
        if self.job is not None:
            self.job.cancel()
        if isinstance(error, FAULTS):
            self._end(FAILED, self._line_of(error) + self._where_kept())
            return
        traceback.print_exception(type(error), error, error.__traceback__)
        self.is_touched = self.is_touched or self.job is not None
        self._end(FAILED, f"the add-on failed: {type(error).__name__}: {error}; undo this step, "
                          f"and report what the console says{self._where_kept()}")

    def _line_of(self, error):
        """One line on a fault, with a remedy that Blender has."""
        line = self._plain(str(error))
        if isinstance(error, OSError) and error.errno == errno.ENOSPC:
            place = error.filename or (self.folder.path if self.folder else folders.parent())
            line = f"{place}: {FULL}"
        if FULL in line:
            return f"{line}; free some of that disk, or choose another folder in Preferences > " \
                   "File Paths > Temporary Files"
        if line.startswith(DARK):
            black = [note for note in self.notes if note.endswith(world.BLACK)]
            return f"{DARK}{black[0]}; use an Environment Texture with an .exr or .hdr image, or " \
                   "add a lamp" if black else \
                   f"{DARK}no lamp shines, no material emits and the World is black; add a lamp, " \
                   "or give the World a colour"
        return line

    def _where_kept(self):
        return "" if self.kept is None else f"; the result of the command is kept in {self.kept}"

    def _plain(self, line):
        """A line of the command without the name of our file."""
        if self.folder is not None:
            line = line.replace(os.path.join(self.folder.path, "scene.glb") + ": ", "")
        return line

    def _end(self, state, message):
        self.state, self.message = state, message
        if self.folder is not None:
            self.folder.remove()


class Current:
    """The bake that runs behind the window, and the last message for the panel."""
    bake = None
    message = ""
    notes = []


def report(operator, bake):
    """Tells the user how a bake ended. Returns the operator's result."""
    Current.message, Current.notes = bake.message, bake.notes
    for note in bake.notes:
        operator.report({"WARNING"}, note)
    if bake.state == DONE:
        operator.report({"INFO"}, bake.message)
        return {"FINISHED"}
    operator.report({"ERROR" if bake.state == FAILED else "WARNING"}, bake.message)
    return {"FINISHED" if bake.is_touched else "CANCELLED"}  # what is finished can be undone


def command_of(context):
    addon = context.preferences.addons.get(__package__)
    return addon.preferences.command if addon is not None else ""


def redraw(context):
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


class ALPENGLOW_OT_bake(bpy.types.Operator):
    """Bake occlusion, light or probes of this scene"""
    bl_idname = "alpenglow.bake"
    bl_label = "Bake"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if context.mode != "OBJECT":
            cls.poll_message_set("Leave this mode first: a bake needs Object Mode")
            return False
        return Current.bake is None

    def execute(self, context):
        bake = Bake(context, context.scene.alpenglow, command_of(context))
        bake.wait(context)
        return report(self, bake)

    def invoke(self, context, event):
        if bpy.app.background:
            return self.execute(context)
        bake = Bake(context, context.scene.alpenglow, command_of(context))
        if bake.state != RUNNING:
            return report(self, bake)
        Current.bake, Current.message, Current.notes = bake, "", list(bake.notes)
        self.timer = context.window_manager.event_timer_add(0.2, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        bake = Current.bake
        redraw(context)
        if bake.state == RUNNING and context.mode != "OBJECT" and bake.job.poll() and \
                not bake.job.cancelled:
            return {"PASS_THROUGH"}  # the result waits until the user leaves the other mode
        if bake.step(context) == RUNNING:
            return {"PASS_THROUGH"}
        self.stop(context)
        return report(self, bake)

    def cancel(self, context):
        """Blender quits, or loads another file."""
        Current.bake.cancel()
        self.stop(context)

    def stop(self, context):
        context.window_manager.event_timer_remove(self.timer)
        Current.bake = None
        redraw(context)


class ALPENGLOW_OT_cancel(bpy.types.Operator):
    """End the bake. The scene stays as it was"""
    bl_idname = "alpenglow.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context):
        return Current.bake is not None

    def execute(self, context):
        Current.bake.interrupt()
        return {"FINISHED"}
