# SPDX-License-Identifier: MIT
"""The scene, the view layer and the objects of a bake, found again when the command has ended.

Until then the user may rename them, undo steps and show another scene. Blender 4 numbers blocks for
a session. Older versions have the name and, for a renamed block, the address."""

import bpy

HAS_NUMBERS = hasattr(bpy.types.ID, "session_uid")


def number_of(block):
    return block.session_uid if HAS_NUMBERS else block.as_pointer()


class Finder:
    """Finds one of some blocks by name or number."""

    def __init__(self, blocks):
        self.by_name = {b.name_full: b for b in blocks}
        self.by_number = {number_of(b): b for b in blocks}

    def find(self, name, number):
        """The block, or None. An address may belong to a new block, so there the name is first."""
        named, numbered = self.by_name.get(name), self.by_number.get(number)
        return (numbered or named) if HAS_NUMBERS else (named or numbered)


class Place:
    def __init__(self, context):
        self.scene = (context.scene.name_full, number_of(context.scene))
        self.view_layer = context.view_layer.name
        self.objects = {o.name_full: number_of(o) for o in bpy.data.objects}

    def override(self, context):
        """A context of this scene and view layer, whatever the window shows; None if the scene was
        removed. A renamed view layer is found if it is the only one."""
        scene = Finder(bpy.data.scenes).find(*self.scene)
        if scene is None:
            return None
        layers = scene.view_layers
        layer = layers.get(self.view_layer) or (layers[0] if len(layers) == 1 else None)
        return None if layer is None else context.temp_override(scene=scene, view_layer=layer)

    def current_keys(self, items):
        """Gives items the keys of objects that were renamed during the bake."""
        finder = Finder(bpy.data.objects)
        names = {}
        for name, number in self.objects.items():
            found = finder.find(name, number)
            if found is not None and (found.name_full == name or
                                      found.name_full not in self.objects):
                names[name] = found.name_full
        for item in items:
            parent, name, place = item.key
            item.key = (names.get(parent, parent), names.get(name, name), place)
