# SPDX-License-Identifier: MIT
"""Settings of a bake, and the panel in the sidebar of the 3D view."""

import textwrap

import bpy

from .bake import Current

WHAT = (("OCCLUSION", "Occlusion", "How much of its surroundings each place sees"),
        ("LIGHT", "Light", "Light of lamps, emission and sky, with all bounces"),
        ("BOTH", "Occlusion and light", "Both on one map"),
        ("PROBES", "Probes", "Light for moving things, as a file beside the .blend"))
SCOPE = (("VISIBLE", "Visible", "Everything that the view shows and that renders"),
         ("SELECTED", "Selected", "Selected objects alone; others shade nothing. All lamps shine"))
STOP = (("QUALITY", "Quality", "An error by name"), ("ERROR", "Error", "An error by number"))
QUALITY = (("PREVIEW", "Preview", "A stated error of 4 %"), ("MEDIUM", "Medium", "1 %"),
           ("HIGH", "High", "0.4 %"))


class AlpenglowSettings(bpy.types.PropertyGroup):
    what: bpy.props.EnumProperty(name="Bake", items=WHAT, default="LIGHT")
    scope: bpy.props.EnumProperty(name="Objects", items=SCOPE, default="VISIBLE")
    stop: bpy.props.EnumProperty(name="Until", items=STOP, default="QUALITY")
    quality: bpy.props.EnumProperty(name="Quality", items=QUALITY, default="MEDIUM")
    error: bpy.props.FloatProperty(
        name="Error", default=1.0, min=0.01, max=100.0, subtype="PERCENTAGE",
        description="Stated error of the map, of its mean")
    size: bpy.props.IntProperty(name="Size", default=1024, min=16, max=16384, subtype="PIXEL",
                                description="Side of the map in texels")
    spacing: bpy.props.FloatProperty(
        name="Spacing", default=0.0, min=0.0, unit="LENGTH",
        description="Distance of neighbouring probes. 0: about 4096 probes in the scene")

    @property
    def bakes_occlusion(self):
        return self.what in ("OCCLUSION", "BOTH")

    @property
    def bakes_light(self):
        return self.what in ("LIGHT", "BOTH")


class ALPENGLOW_PT_panel(bpy.types.Panel):
    bl_label = "Alpenglow"
    bl_idname = "ALPENGLOW_PT_panel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Alpenglow"

    def draw(self, context):
        settings, layout = context.scene.alpenglow, self.layout
        layout.use_property_split = True
        layout.prop(settings, "what")
        layout.prop(settings, "scope")
        if settings.what == "PROBES":
            layout.prop(settings, "spacing")
        else:
            layout.prop(settings, "stop")
            layout.prop(settings, "quality" if settings.stop == "QUALITY" else "error")
            layout.prop(settings, "size")
        if Current.bake is not None:
            layout.label(text=Current.bake.job.describe())
            layout.operator("alpenglow.cancel", icon="CANCEL")
        else:
            layout.operator("alpenglow.bake", icon="LIGHT")
            layout.operator("alpenglow.remove", icon="TRASH")
        letters = max(20, int(context.region.width / (7 * context.preferences.system.ui_scale)) - 3)
        column = layout.column(align=True)
        for message in [Current.message] + Current.notes:
            for line in textwrap.wrap(message, letters):
                column.label(text=line)
