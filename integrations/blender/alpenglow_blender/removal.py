# SPDX-License-Identifier: MIT
"""Takes bakes of a file back: nodes, UV maps, images and copies go, hidden originals show again.

Cut polygons and their normals stay, and so do meshes that objects shared before the bake."""

import bpy

from . import apply, bake, copies, export, nodes, repair, uv


def local(blocks):
    return [block for block in blocks if block.library is None]


def remove_bakes():
    """Returns the number of objects that a bake had changed, made or hidden."""
    repair.repair()
    originals = [o for o in local(bpy.data.objects) if copies.show_original(o)]
    made = [o for o in local(bpy.data.objects) if export.SOURCE in o]
    for o in made:
        copies.remove_object(o)
    for mesh in [m for m in local(bpy.data.meshes) if nodes.MARK in m and m.users == 0]:
        bpy.data.meshes.remove(mesh)
    for o in local(bpy.data.objects):
        give_materials_back(o)
    for material in local(bpy.data.materials):
        if material.node_tree is not None:
            nodes.remove(material.node_tree)
            take_nodes(material)
        if material.users == 0 and (export.SOURCE in material or is_made(material)):
            bpy.data.materials.remove(material)
    meshes = {m for m in local(bpy.data.meshes) if uv.remove(m)}
    for mesh in meshes:
        if mesh.pop(apply.BARE_MESH, False) and not any(mesh.materials):
            mesh.materials.clear()
    for group in [g for g in local(bpy.data.node_groups) if g.get(nodes.MARK) and g.users == 0]:
        bpy.data.node_groups.remove(group)
    apply.remove_unused(apply.Page())
    return len(originals) + len(made) + sum(o.data in meshes for o in local(bpy.data.objects))


def take_nodes(material):
    """Returns a material that had no nodes to that, unless the user has added some."""
    tree = material.node_tree
    if len(tree.nodes) and all(apply.PLAIN in node for node in tree.nodes):
        tree.nodes.clear()
        material.use_nodes = False


def is_made(material):
    return material.get(nodes.MARK) == apply.MADE


def give_materials_back(o):
    """Gives slots the materials that they had before they got a copy or a new one."""
    if o.data is not None and o.data.library is not None:
        return
    for slot in o.material_slots:
        if slot.material is None:
            continue
        if export.SOURCE in slot.material:
            slot.material = slot.material[export.SOURCE]
        elif is_made(slot.material):
            slot.material = None


class ALPENGLOW_OT_remove(bpy.types.Operator):
    """Take the bakes of this file back: nodes, UV maps, images and copies"""
    bl_idname = "alpenglow.remove"
    bl_label = "Remove Bake"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT" and bake.Current.bake is None

    def execute(self, context):
        count = remove_bakes()
        if count == 0:
            self.report({"WARNING"}, "no object of this file has a bake")
            return {"CANCELLED"}
        self.report({"INFO"}, "the bake of 1 object is removed" if count == 1 else
                    f"the bakes of {count} objects are removed")
        return {"FINISHED"}
