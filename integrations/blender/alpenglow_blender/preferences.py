# SPDX-License-Identifier: MIT
"""Preferences of the add-on: the place of the command, and whether it works."""

import bpy

from . import run


class Checked:
    """The last check, for the drawing of the preferences."""
    command = None
    line = ""


def check(wanted):
    """One line on the command: version and path, or the fault."""
    try:
        path, version = run.check_command(wanted)
        return f"alpenglow {version}: {path}", True
    except run.CommandError as error:
        return str(error), False


class ALPENGLOW_OT_check(bpy.types.Operator):
    """Run the command to see whether it works"""
    bl_idname = "alpenglow.check"
    bl_label = "Check"

    def execute(self, context):
        addon = context.preferences.addons.get(__package__)
        Checked.command = addon.preferences.command if addon is not None else ""
        Checked.line, works = check(Checked.command)
        self.report({"INFO"} if works else {"ERROR"}, Checked.line)
        return {"FINISHED"} if works else {"CANCELLED"}


class AlpenglowPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    command: bpy.props.StringProperty(
        name="Command", subtype="FILE_PATH",
        description="The command alpenglow, as a path or a name on PATH. Empty: alpenglow")

    def draw(self, context):
        row = self.layout.row()
        row.prop(self, "command")
        row.operator("alpenglow.check")
        if Checked.line and Checked.command == self.command:
            self.layout.label(text=Checked.line)
