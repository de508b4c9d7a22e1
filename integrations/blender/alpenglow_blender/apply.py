# SPDX-License-Identifier: MIT
"""Puts a bake onto the objects of the scene: UV map, images, node groups.

The result is read from the .glb that the command wrote: node by `extras.item`, loop by _LOOP."""

import os
from dataclasses import dataclass

import bpy
import numpy

from . import copies, cut, export, glb, nodes, surface, uv

BARE_MESH = "alpenglow_bare"  # property of a mesh that had no material
PLAIN = "alpenglow_plain"  # property of the nodes of a material that had none
MADE = "made"  # value of nodes.MARK at a material that a bake made for none


class ApplyError(Exception):
    """One object, or the whole result, cannot be applied. The message is for the user."""


@dataclass
class Page:
    """Maps of the bake: images of Blender, or None. Light is E / pi = intensity x texel."""
    occlusion: object = None
    light: object = None
    intensity: float = 1.0

    def remove(self):
        for image in (self.occlusion, self.light):
            if image is not None:
                bpy.data.images.remove(image)


class Result:
    """The .glb that the command wrote."""

    def __init__(self, path):
        self.reader = glb.Reader(path)
        self.folder = os.path.dirname(path)
        with self.reader.checked("nodes"):
            self.nodes = {n["extras"]["item"]: n for n in self.reader.elements("nodes")
                          if "item" in n.get("extras", {}) and "mesh" in n}

    def texture_of(self, material):
        """(coordinate set, image of occlusion or None, light map or None) of a material."""
        occlusion = material.get("occlusionTexture")
        light = material.get("extras", {}).get("lightmap")
        if occlusion is None and light is None:
            return None, None, None
        found = occlusion or light
        image = None
        if occlusion is not None:
            image = self.reader.elements("textures")[occlusion["index"]]["source"]
        return found.get("texCoord", 0), image, light

    def corners(self, item, loop_count):
        """(loops [triangles][3], Blender's coordinates [triangles][3][2]) of an item."""
        if item not in self.nodes:
            raise ApplyError("is not in the result; bake again")
        with self.reader.checked(f"mesh of item {item}"):
            mesh = self.reader.elements("meshes")[self.nodes[item]["mesh"]]
            parts = [self.corners_of(primitive) for primitive in mesh["primitives"]]
            loops, places = (numpy.concatenate(arrays) for arrays in zip(*parts))
            if loops.max() >= loop_count:
                raise ValueError(f"loop {loops.max()} of {loop_count}")
        return loops, places

    def corners_of(self, primitive):
        material = self.reader.elements("materials")[primitive["material"]]
        name = f"TEXCOORD_{self.texture_of(material)[0]}"
        attributes = primitive["attributes"]
        if name not in attributes:
            raise ApplyError("has no map: see the warnings of the command")
        indices = self.reader.accessor(primitive["indices"])[:, 0].astype(numpy.int64)
        numbers = self.reader.accessor(attributes["_LOOP"]).astype(numpy.int64)
        numbers = numbers @ numpy.array([1, 1 << 8, 1 << 16, 1 << 24])
        found = numpy.array(self.reader.accessor(attributes[name]), numpy.float32)
        found[:, 1] = 1 - found[:, 1]
        return numbers[indices].reshape(-1, 3), found[indices].reshape(-1, 3, 2)

    def maps(self):
        """A Page of what all materials read: index of the image of occlusion, `lightmap`."""
        with self.reader.checked("materials"):
            found = [self.texture_of(m) for m in self.reader.elements("materials")]
            occlusions = {image for _, image, _ in found if image is not None}
            lights = {light["uri"]: light for _, _, light in found if light is not None}
        if not occlusions and not lights:
            raise ApplyError("the command wrote no map: see its warnings")
        if len(occlusions) > 1 or len(lights) > 1:
            raise ApplyError("the bake has several pages, which the add-on does not apply")
        return Page(next(iter(occlusions), None), next(iter(lights.values()), None))

    def page(self, maps):
        """The maps as packed images."""
        page = Page()
        try:
            with self.reader.checked("maps"):
                if maps.occlusion is not None:
                    page.occlusion = packed(self.written(maps.occlusion), "occlusion")
                if maps.light is not None:
                    page.intensity = float(maps.light["intensity"])
                    path = os.path.join(self.folder, maps.light["uri"])
                    page.light = packed(path, "light")
                    page.light["units"] = maps.light["units"]
        except Exception:
            page.remove()
            raise
        return page

    def written(self, index):
        """Writes an image of the .glb into a file, and returns its path."""
        path = os.path.join(self.folder, "occlusion.png")
        with open(path, "wb") as file:
            file.write(self.reader.view(self.reader.elements("images")[index]["bufferView"]))
        return path


def packed(path, kind):
    """An image of numbers, packed into the .blend."""
    image = bpy.data.images.load(path, check_existing=False)
    image.name = name_of_map(kind)
    image.colorspace_settings.name = "Non-Color"
    image.alpha_mode = "NONE"
    image[nodes.MARK] = kind
    image.pack()
    image.filepath_raw = f"//{image.name}{os.path.splitext(path)[1]}"
    return image


class Applier:
    """Applies a Result to the scene and view layer of a context."""

    def __init__(self, context, items, result):
        self.context, self.items, self.result = context, items, result
        self.notes, self.count, self.copied = [], 0, []
        self.copies = copies.Copies(context, items, self.take, self.notes)

    def apply(self):
        """Applies all items. Objects that cannot take the result cost a note each. Raises
        ApplyError before the scene changes."""
        maps = self.result.maps()
        self.context.view_layer.update()
        wanted = {i.key: n for n, i in enumerate(self.items) if i.fate != export.KEPT}
        own = self.find_own(wanted)
        try:
            self.copies.gather(wanted)
            self.check_shown([o for o, _ in own], maps)
            page = self.result.page(maps)
        except Exception:
            self.copies.discard()
            raise
        targets = [(with_own_mesh(o), corners) for o, corners in own] + self.copies.place()
        self.copies.remove_replaced()
        self.add_uv_maps(targets)
        self.dress([target for target, _ in targets], page)
        self.copies.hide_originals()
        remove_replaced(self.copied)
        remove_unused(page)
        self.count = len(targets)

    def take(self, index, mesh):
        """Loops and coordinates of the corners of an item, or None with a note."""
        item = self.items[index]
        if export.topology_of(mesh) != item.topology:
            self.notes.append(f"{item.name} changed during the bake; bake again")
            return None
        try:
            return self.result.corners(index, len(mesh.loops))
        except ApplyError as error:
            self.notes.append(f"{item.name} {error}")
            return None

    def find_own(self, wanted):
        """(object, corners) of objects that take the result themselves."""
        found = []
        by_name = {o.name_full: o for o in bpy.data.objects if o.users_scene}
        for key, index in wanted.items():
            if self.items[index].fate != export.OWN:
                continue
            target = by_name.get(key[1])
            if target is None or target.type != "MESH":
                self.notes.append(f"{self.items[index].name} was removed during the bake")
                continue
            corners = self.take(index, target.data)
            slots = [slot.material for slot in target.material_slots]
            if corners is not None and uv.has_room(target.data, slots, target.name, self.notes):
                found.append((target, corners))
        return found

    def check_shown(self, own, maps):
        """Raises ApplyError if no object took the result, or if no material shows a map."""
        slots = [[slot.material for slot in o.material_slots] for o in own]
        slots += [shape.slots for shape in self.copies.shapes]
        if not slots:
            raise ApplyError("no object took the result: " + "; ".join(self.notes))
        materials = dict.fromkeys(m for some in slots for m in some or [None])
        reasons = [obstacles(m, surface.read(m)[0], maps) for m in materials]
        if all(some and all(some) for some in reasons):
            lines = dict.fromkeys(line for some in reasons for line in some)
            raise ApplyError("no material can show the map, so nothing changed: " +
                             "; ".join(lines))

    def add_uv_maps(self, targets):
        polygons = 0
        for target, (loops, places) in targets:
            slots = [slot.material for slot in target.material_slots]
            name = uv.add(target.data, slots, loops, places)
            if name != nodes.UV_MAP:
                self.notes.append(f"{target.name} has a UV map {nodes.UV_MAP} that no bake made: "
                                  f"the map of the bake is {name}")
            polygons += cut.cut(target.data, name, loops, places)
        if polygons:
            what, whose = ("polygon lies", "its") if polygons == 1 else ("polygons lie", "their")
            self.notes.append(f"{polygons} {what} in two charts: {whose} diagonals are edges")

    def dress(self, targets, page):
        """Gives materials their nodes. A material that others use too is copied, and so is one for
        objects whose UV maps have other names."""
        baked, dressed = set(targets), {}
        shared = {m for o in bpy.data.objects if o not in baked for m in materials_of(o)}
        for target in targets:
            uv_map = target.data[uv.OURS]
            if not target.material_slots:
                target.data.materials.append(None)
                target.data[BARE_MESH] = True
            for slot in target.material_slots:
                key = (slot.material, uv_map)
                if key not in dressed:
                    dressed[key] = self.dressed(slot.material, slot.material in shared, page,
                                                uv_map)
                    shared.add(slot.material)
                slot.material = dressed[key]

    def dressed(self, material, is_shared, page, uv_map):
        if material is None:
            material = bpy.data.materials.new("Alpenglow")
            material[nodes.MARK] = MADE
            with_nodes(material, surface.BARE)
        elif is_shared or material.library is not None or has_stored_nodes(material):
            material = copy_of(material)
            self.copied.append(material)
        if not material.use_nodes:
            with_nodes(material, material.diffuse_color[:3])
        tree = material.node_tree
        nodes.remove(tree)
        read, _ = surface.read(material)
        reasons = obstacles(material, read, page)
        self.notes += [line for line in dict.fromkeys(reasons) if line]
        shown = [not line for line in reasons]
        if page.occlusion is not None and shown.pop(0):
            nodes.show_occlusion(tree, read, page.occlusion, uv_map)
        if page.light is not None and shown.pop(0):
            nodes.show_light(tree, read, page.light, page.intensity, uv_map)
        return material


def obstacles(material, read, maps):
    """Why a material does not show each map, occlusion before light; "" for one that it shows."""
    if material is not None and material.use_nodes and \
            nodes.output_of(material.node_tree) is None:
        fault = f"material {material.name} has no output: it shows no map"
        return [fault for image in (maps.occlusion, maps.light) if image is not None]
    reasons = []
    if maps.occlusion is not None:
        is_shown = read.tinted or material is None or not material.use_nodes
        reasons.append("" if is_shown else
                       f"material {material.name} has no colour for occlusion: it keeps its look")
    if maps.light is not None:
        reasons.append("" if not read.is_pane() else
                       f"material {material.name} lets light through: it keeps its look")
    return reasons


def with_own_mesh(target):
    """Gives an object a mesh that no other has, for a UV map of its own."""
    if target.data.users > 1 or target.data.library is not None:
        target.data = target.data.copy()
    return target


def copy_of(material):
    """MATERIAL.baked, which remembers its original."""
    made = material.copy()
    if export.SOURCE not in made:
        made[export.SOURCE] = material
    made.name = name_of_copy(made)
    return made


def name_of_copy(material):
    source = material[export.SOURCE]
    return f"{(material if source is None else source).name.removesuffix('.baked')}.baked"


def remove_replaced(copied):
    """Removes copies of earlier bakes that no object has any more. The new get their names."""
    for material in [m for m in bpy.data.materials if export.SOURCE in m and m.users == 0]:
        if material.library is None and material not in copied:
            bpy.data.materials.remove(material)
    for material in copied:
        material.name = name_of_copy(material)


def has_stored_nodes(material):
    """Whether it keeps nodes that it does not use, which stay."""
    return not material.use_nodes and material.node_tree is not None and \
        len(material.node_tree.nodes) > 0


def remove_unused(page):
    """Removes maps of earlier bakes that no material reads any more. The new get their names."""
    new = [image for image in (page.occlusion, page.light) if image is not None]
    for image in [i for i in bpy.data.images if i.get(nodes.MARK) and i.users == 0]:
        if image not in new:
            bpy.data.images.remove(image)
    for image in new:
        image.name = name_of_map(image[nodes.MARK])


def name_of_map(kind):
    return f"Alpenglow {kind}"


def materials_of(o):
    return {slot.material for slot in o.material_slots if slot.material is not None}


def with_nodes(material, colour):
    """Gives a material the nodes of what Cycles shows without any: a diffuse colour. Those that it
    keeps go."""
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*colour, 1.0)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    output.location = (300, 0)
    tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    diffuse[PLAIN] = output[PLAIN] = 1
