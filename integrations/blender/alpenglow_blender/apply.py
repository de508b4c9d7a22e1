# SPDX-License-Identifier: MIT
"""Puts a bake onto the objects of the scene: UV map, images, node groups.

The result is read from the .glb that the command wrote: node by `extras.item`, loop by _LOOP."""

import os
from dataclasses import dataclass

import bpy
import numpy

from . import cut, export, glb, nodes, surface


class ApplyError(Exception):
    """One object, or the whole result, cannot be applied. The message is for the user."""


@dataclass
class Page:
    """Maps of the bake: images of Blender, or None. Light is E / pi = intensity x texel."""
    occlusion: object = None
    light: object = None
    intensity: float = 1.0


class Result:
    """The .glb that the command wrote."""

    def __init__(self, path):
        self.reader = glb.Reader(path)
        self.folder = os.path.dirname(path)
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

    def corners(self, item):
        """(loops [triangles][3], Blender's coordinates [triangles][3][2]) of an item."""
        loops, places = [], []
        mesh = self.reader.elements("meshes")[self.nodes[item]["mesh"]]
        for primitive in mesh["primitives"]:
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
            loops.append(numbers[indices].reshape(-1, 3))
            places.append(found[indices].reshape(-1, 3, 2))
        return numpy.concatenate(loops), numpy.concatenate(places)

    def page(self):
        """The maps of all materials, as packed images."""
        found = [self.texture_of(m) for m in self.reader.elements("materials")]
        occlusions = {image for _, image, _ in found if image is not None}
        lights = {light["uri"]: light for _, _, light in found if light is not None}
        if not occlusions and not lights:
            raise ApplyError("the command wrote no map: see its warnings")
        if len(occlusions) > 1 or len(lights) > 1:
            raise ApplyError("the bake has several pages, which the add-on does not apply")
        page = Page()
        for index in occlusions:
            path = os.path.join(self.folder, "occlusion.png")
            with open(path, "wb") as file:
                image = self.reader.elements("images")[index]
                file.write(self.reader.view(image["bufferView"]))
            page.occlusion = packed(path, "occlusion")
        for uri, light in lights.items():
            page.light = packed(os.path.join(self.folder, uri), "light")
            page.light["units"] = light["units"]
            page.intensity = float(light["intensity"])
        return page


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
    def __init__(self, context, items, result):
        self.context, self.items, self.result = context, items, result
        self.notes, self.made, self.hidden, self.count = [], {}, set(), 0

    def apply(self):
        """Applies all items. Objects that cannot take the result cost a note each."""
        page = self.result.page()
        self.context.view_layer.update()
        wanted = {i.key: n for n, i in enumerate(self.items) if i.fate != export.KEPT}
        targets = self.find_own(wanted) + self.make_baked(wanted)
        if not targets:
            remove_unused(Page())
            raise ApplyError("no object took the result: " + "; ".join(self.notes))
        self.remove_replaced()
        polygons = sum(add_uv_map(target.data, *corners) for target, corners in targets)
        if polygons:
            self.notes.append(f"{polygons} polygons lie in two charts each: their diagonals are "
                              "edges")
        self.dress([target for target, _ in targets], page)
        self.hide_originals()
        remove_unused(page)
        self.count = len(targets)

    def take(self, index, topology):
        """Loops and coordinates of the corners of an item, or None with a note."""
        item = self.items[index]
        if topology != item.topology:
            self.notes.append(f"{item.name} changed during the bake; bake again")
            return None
        try:
            return self.result.corners(index)
        except ApplyError as error:
            self.notes.append(f"{item.name} {error}")
            return None

    def find_own(self, wanted):
        """(object, corners) of objects that take the result themselves."""
        found = []
        by_name = {o.name_full: o for o in self.context.view_layer.objects}
        for key, index in wanted.items():
            if self.items[index].fate != export.OWN:
                continue
            target = by_name.get(key[1])
            if target is None or target.type != "MESH":
                self.notes.append(f"{self.items[index].name} was removed during the bake")
                continue
            corners = self.take(index, export.topology_of(target.data))
            if corners is None or not self.has_room(target):
                continue
            if target.data.users > 1 or target.data.library is not None:
                target.data = target.data.copy()  # objects that share a mesh have maps of their own
            found.append((target, corners))
        return found

    def has_room(self, target):
        layers = target.data.uv_layers
        if nodes.UV_MAP in layers or len(layers) < 8:
            return True
        self.notes.append(f"{target.name} has eight UV maps; remove one and bake again")
        return False

    def make_baked(self, wanted):
        """(object, corners) of new objects NAME.baked with evaluated meshes."""
        depsgraph = self.context.evaluated_depsgraph_get()
        shapes = []
        for instance in depsgraph.object_instances:
            index = wanted.get(export.key_of(instance))
            if index is None or self.items[index].fate != export.BAKED:
                continue
            # With all layers Blender evaluates the object again, which instances of nodes are not.
            mesh = bpy.data.meshes.new_from_object(
                instance.object, preserve_all_data_layers=not instance.is_instance,
                depsgraph=depsgraph)
            slots = [export.material_of(instance.object, mesh, i)
                     for i in range(max(len(instance.object.material_slots), len(mesh.materials)))]
            shown = (instance.parent if instance.is_instance else instance.object).original
            shapes.append((index, mesh, slots, instance.matrix_world.copy(), shown))
        found = []
        for index, mesh, slots, matrix, shown in shapes:
            corners = self.take(index, export.topology_of(mesh))
            if corners is None:
                bpy.data.meshes.remove(mesh)
                continue
            found.append((self.place(mesh, slots, matrix, shown, self.items[index].name), corners))
            self.hidden.add(shown)
        self.place_lamps(depsgraph)
        return found

    def place_lamps(self, depsgraph):
        """Lamps of instancers come back too: the next bake needs them."""
        lamps = [(i.parent.original, i.object.original, i.matrix_world.copy())
                 for i in depsgraph.object_instances if i.is_instance and i.object.type == "LIGHT"
                 and i.parent.original in self.hidden]
        for shown, lamp, matrix in lamps:
            self.place_object(lamp.data, matrix, shown, f"{shown.name}/{lamp.name}")

    def place(self, mesh, slots, matrix, shown, name):
        mesh.materials.clear()
        for material in slots:
            mesh.materials.append(material)
        mesh.name = f"{name}.baked"
        return self.place_object(mesh, matrix, shown, name)

    def place_object(self, data, matrix, shown, name):
        target = bpy.data.objects.new(f"{name}.baked", data)
        target[export.SOURCE] = shown
        target.matrix_world = matrix
        inside = [c for c in shown.users_collection if c.library is None]
        (inside[0] if inside else self.context.scene.collection).objects.link(target)
        self.made[target] = shown
        return target

    def remove_replaced(self):
        """Removes what an earlier bake made of the same originals. The new get its names."""
        sources = set(self.made.values())
        for old in [o for o in bpy.data.objects if o.get(export.SOURCE) in sources
                    and o not in self.made and o.library is None]:
            name, data = old.name, old.data
            bpy.data.objects.remove(old)
            if isinstance(data, bpy.types.Mesh) and data.users == 0:
                bpy.data.meshes.remove(data)
            heir = next((o for o in self.made if o.name.startswith(f"{name}.")), None)
            if heir is not None:
                heir.name = name

    def dress(self, targets, page):
        """Gives materials their nodes. A material that others use too is copied."""
        baked, copies = set(targets), {}
        others = {m for o in bpy.data.objects if o not in baked for m in materials_of(o)}
        for target in targets:
            if not target.material_slots:
                target.data.materials.append(None)
            for slot in target.material_slots:
                key = slot.material
                if key not in copies:
                    copies[key] = self.dressed(key, key in others, page)
                slot.material = copies[key]

    def dressed(self, material, is_shared, page):
        if material is None:
            material = bpy.data.materials.new("Alpenglow")
            with_nodes(material, surface.BARE)
        elif is_shared or material.library is not None:
            material = material.copy()
            material.name = f"{material.name.rpartition('.')[0] or material.name}.baked"
        if not material.use_nodes:
            with_nodes(material, material.diffuse_color[:3])
        tree = material.node_tree
        nodes.remove(tree)
        read, _ = surface.read(material)
        if nodes.output_of(tree) is None:
            self.notes.append(f"material {material.name} has no output: it shows no map")
            return material
        if page.occlusion is not None:
            nodes.show_occlusion(tree, read, page.occlusion)
        if page.light is not None and read.is_pane():
            self.notes.append(f"material {material.name} lets light through: it keeps its look")
        elif page.light is not None:
            nodes.show_light(tree, read, page.light, page.intensity)
        return material

    def hide_originals(self):
        for shown in self.hidden:
            shown.hide_render = True
            shown.hide_set(True)


def remove_unused(page):
    """Removes maps of earlier bakes that no material reads any more."""
    for image in [i for i in bpy.data.images if i.get(nodes.MARK) and i.users == 0]:
        bpy.data.images.remove(image)
    for image in (page.occlusion, page.light):
        if image is not None:
            image.name = name_of_map(image[nodes.MARK])


def name_of_map(kind):
    return f"Alpenglow {kind}"


def materials_of(o):
    return {slot.material for slot in o.material_slots if slot.material is not None}


def with_nodes(material, colour):
    """Gives a material the nodes of what Cycles shows without any: a diffuse colour."""
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*colour, 1.0)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    output.location = (300, 0)
    tree.links.new(diffuse.outputs[0], output.inputs["Surface"])


def add_uv_map(mesh, loops, places):
    """Adds the UV map of a bake. Returns the number of polygons that had to be cut."""
    layer = mesh.uv_layers.get(nodes.UV_MAP) or mesh.uv_layers.new(name=nodes.UV_MAP, do_init=False)
    uvs = numpy.zeros((len(mesh.loops), 2), numpy.float32)  # polygons without area have no triangle
    uvs[loops] = places
    layer.data.foreach_set("uv", uvs.ravel())
    mesh.update()
    return cut.cut(mesh, nodes.UV_MAP, loops, places)
