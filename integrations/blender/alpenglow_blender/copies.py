# SPDX-License-Identifier: MIT
"""New objects NAME.baked, with evaluated meshes, of originals that cannot take a bake themselves.

An original is hidden only if everything that it shows has a copy. Otherwise it stays as it is."""

from dataclasses import dataclass
from typing import Any

import bpy

from . import export, nodes, presence, uv

HIDDEN = "alpenglow_hidden"  # property of an original: how it was hidden
SHARED = {"LIGHT", "VOLUME", "CURVES", "GPENCIL", "GREASEPENCIL", "LIGHT_PROBE"}  # copied as is
FLAGS = ("hide_select", "visible_camera", "visible_diffuse", "visible_glossy",
         "visible_transmission", "visible_volume_scatter", "visible_shadow", "is_holdout",
         "is_shadow_catcher", "pass_index", "color", "lightgroup", "display_type")


@dataclass
class Shape:
    """A mesh that becomes an object. inner: the original object that has the shape; shown: the
    original that shows it, an instancer or the same; corners: see Result.corners."""
    name: str
    mesh: Any
    slots: list
    matrix: Any
    shown: Any
    inner: Any
    corners: Any


def shown_of(instance):
    return (instance.parent if instance.is_instance else instance.object).original


def key_of(instance):
    """The key of export.py, by the names of the originals."""
    parent = instance.parent.original.name_full if instance.is_instance else ""
    return (parent, instance.object.original.name_full, tuple(instance.persistent_id))


def has_hair(o):
    return any(s.settings.type == "HAIR" and s.settings.render_type == "PATH"
               for s in o.particle_systems)


class Copies:
    """gather() evaluates the scene and changes nothing; place() adds the objects."""

    def __init__(self, context, items, take, notes):
        self.context, self.items, self.take, self.notes = context, items, take, notes
        self.shapes, self.others, self.lacks, self.made = [], [], {}, {}

    def gather(self, wanted):
        """wanted: index of the item of each key."""
        depsgraph = self.context.evaluated_depsgraph_get()
        parents = {key[0] for key in wanted}
        missing = {i for i in wanted.values() if self.items[i].fate == export.BAKED}
        for instance in depsgraph.object_instances:
            index = wanted.get(key_of(instance))
            if index in missing:
                missing.discard(index)
                self.gather_shape(instance, index, depsgraph)
            elif instance.is_instance and instance.show_self and \
                    instance.parent.original.name_full in parents and \
                    not instance.object.original.hide_render:
                self.gather_other(instance)
        self.notes += [f"{self.items[i].name} was removed during the bake" for i in sorted(missing)]
        self.leave_incomplete()

    def gather_shape(self, instance, index, depsgraph):
        shown, inner = shown_of(instance), instance.object.original
        if has_hair(inner):
            self.lacks.setdefault(shown, f"the hair of {inner.name} takes no part in a bake")
        # With all layers Blender evaluates the object again, which instances of nodes are not.
        mesh = bpy.data.meshes.new_from_object(
            instance.object, preserve_all_data_layers=not instance.is_instance,
            depsgraph=depsgraph)
        slots = [export.material_of(instance.object, mesh, i)
                 for i in range(max(len(instance.object.material_slots), len(mesh.materials)))]
        if inner.type == "MESH" and uv.OURS in inner.data:
            mesh[uv.OURS] = inner.data[uv.OURS]
        corners = self.take(index, mesh)
        if corners is None or not uv.has_room(mesh, slots, self.items[index].name, self.notes):
            bpy.data.meshes.remove(mesh)
            self.lacks.setdefault(shown, f"{self.items[index].name} has no result")
            return
        self.shapes.append(Shape(self.items[index].name, mesh, slots, instance.matrix_world.copy(),
                                 shown, inner, corners))

    def gather_other(self, instance):
        """Objects that an instancer shows beside its baked shapes. Lamps, for one, light the next
        bake."""
        shown, inner = shown_of(instance), instance.object.original
        if instance.object.type in SHARED and instance.object.type == inner.type:
            self.others.append((inner, instance.matrix_world.copy(), shown))
        elif instance.object.type in SHARED | {"POINTCLOUD"}:
            self.lacks.setdefault(shown, f"{inner.name} shows more than meshes")
        elif instance.object.type == inner.type and inner.type in export.SHAPED:
            mesh = instance.object.to_mesh()
            if mesh is not None and len(mesh.polygons):
                self.note_lack(instance, mesh)
            instance.object.to_mesh_clear()

    def note_lack(self, instance, mesh):
        """Notes why a shape of an instancer has no result. One without area shows nothing."""
        shown, inner = shown_of(instance), instance.object.original
        reason = presence.fault_of(mesh, instance.matrix_world)
        if key_of(instance) in {i.key for i in self.items if i.fate == export.KEPT}:
            reason = "gets no map"
        if reason != presence.NO_AREA:
            self.lacks.setdefault(shown, f"{inner.name} {reason or 'was added during the bake'}")

    def leave_incomplete(self):
        """Leaves out originals that show something without a copy."""
        for shown in {s.shown for s in self.shapes if s.shown in self.lacks}:
            self.notes.append(f"{shown.name} stays as it is: {self.lacks[shown]}")
        self.discard(lambda shown: shown in self.lacks)
        owners = {s.shown for s in self.shapes}
        self.others = [other for other in self.others if other[2] in owners]

    def discard(self, is_left_out=lambda shown: True):
        """Removes gathered meshes."""
        for shape in [s for s in self.shapes if is_left_out(s.shown)]:
            bpy.data.meshes.remove(shape.mesh)
            self.shapes.remove(shape)

    def place(self):
        """Adds the objects. Returns (object, corners) of those that take the bake."""
        found = []
        for shape in self.shapes:
            shape.mesh.materials.clear()
            for material in shape.slots:
                shape.mesh.materials.append(material)
            shape.mesh.name = f"{shape.name}.baked"
            shape.mesh[nodes.MARK] = 1
            target = bpy.data.objects.new(f"{shape.name}.baked", shape.mesh)
            self.place_object(target, shape.matrix, shape.shown, shape.inner)
            found.append((target, shape.corners))
        for inner, matrix, shown in self.others:
            target = inner.copy()
            target.name = f"{shown.name}/{inner.name}.baked"
            target.animation_data_clear()
            target.constraints.clear()
            target.parent, target.hide_viewport, target.hide_render = None, False, False
            self.place_object(target, matrix, shown, inner)
        return found

    def place_object(self, target, matrix, shown, inner):
        """Adds an object in place of `shown`, with the flags of `inner`."""
        target[export.SOURCE] = shown
        for flag in FLAGS:
            if hasattr(inner, flag):
                setattr(target, flag, getattr(inner, flag))
        for collection in self.collections_of(shown):
            collection.objects.link(target)
        adopt(target, shown)
        target.matrix_world = matrix
        self.made[target] = shown

    def collections_of(self, shown):
        """Collections of an original that the scene shows; the scene's own if there is none."""
        scene = self.context.scene.collection
        inside = {scene, *scene.children_recursive}
        local = [c for c in shown.users_collection if c.library is None]
        return [c for c in local if c in inside] or local or [scene]

    def remove_replaced(self):
        """Removes what an earlier bake made of the same originals. The new get its names."""
        sources = set(self.made.values())
        for old in [o for o in bpy.data.objects if o.get(export.SOURCE) in sources
                    and o not in self.made and o.library is None]:
            name = old.name
            remove_object(old)
            heir = next((o for o in self.made if o.name.startswith(f"{name}.")), None)
            if heir is not None:
                heir.name = name
                if heir.type == "MESH":
                    heir.data.name = name

    def hide_originals(self):
        layer = self.context.view_layer
        held = set(layer.objects)
        for shown in set(self.made.values()):
            shown.hide_render = True
            if shown in held:
                shown.hide_set(True, view_layer=layer)
                shown[HIDDEN] = [self.context.scene.name, layer.name]
            else:  # of another scene, in the background
                shown.hide_viewport = True
                shown[HIDDEN] = []


def adopt(target, shown):
    """Gives a copy the parent of its original. Shapes are evaluated: no parent bends them again."""
    parent = shown.parent
    if parent is None or parent.instance_type in ("VERTS", "FACES"):
        return
    target.parent = parent
    if shown.parent_type in ("BONE", "VERTEX", "VERTEX_3"):
        target.parent_type, target.parent_bone = shown.parent_type, shown.parent_bone
        target.parent_vertices = shown.parent_vertices
    target.matrix_parent_inverse = shown.matrix_parent_inverse


def remove_object(o):
    """Removes an object, and its mesh if no other has it."""
    data = o.data
    bpy.data.objects.remove(o)
    if isinstance(data, bpy.types.Mesh) and data.users == 0:
        bpy.data.meshes.remove(data)


def show_original(shown):
    """Shows an original that a bake has hidden. Returns whether one had."""
    hidden = shown.get(HIDDEN)
    if hidden is None:
        return False
    shown.hide_render = False
    names = list(hidden)
    if not names:
        shown.hide_viewport = False
    for scene in bpy.data.scenes:
        for layer in scene.view_layers:
            if [scene.name, layer.name] == names and shown in set(layer.objects):
                shown.hide_set(False, view_layer=layer)
    del shown[HIDDEN]
    return True
