# SPDX-License-Identifier: MIT
"""Alpenglow for Blender: bakes occlusion, light and probes by the command alpenglow."""

import bpy

try:
    import numpy  # pylint: disable=unused-import # noqa: F401
except ImportError:
    raise ImportError("Alpenglow needs numpy in Blender's Python; Debian has it as python3-numpy, "
                      "for the Python in /usr/bin") from None

from . import bake, panel, preferences, removal

bl_info = {
    "name": "Alpenglow",
    "author": "Alpenglow contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Alpenglow",
    "description": "Bakes occlusion, light and probes with the command alpenglow",
    "category": "Render",
}

CLASSES = (panel.AlpenglowSettings, panel.ALPENGLOW_PT_panel, bake.ALPENGLOW_OT_bake,
           bake.ALPENGLOW_OT_cancel, removal.ALPENGLOW_OT_remove, preferences.ALPENGLOW_OT_check,
           preferences.AlpenglowPreferences)


def register():
    for kind in CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.Scene.alpenglow = bpy.props.PointerProperty(type=panel.AlpenglowSettings)


def unregister():
    if bake.Current.bake is not None:
        bake.Current.bake.cancel()
    del bpy.types.Scene.alpenglow
    for kind in reversed(CLASSES):
        bpy.utils.unregister_class(kind)
