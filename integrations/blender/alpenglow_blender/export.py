# SPDX-License-Identifier: MIT
"""Writes what is selected or visible as a .glb that the command bakes.

Each loop of Blender becomes one vertex. The attribute _LOOP [n][4] holds the number of the loop,
the least significant byte first. The result finds its loop by it in any order of vertices.
`extras.item` of a node is the index of its Item."""

import zlib
from dataclasses import dataclass

import numpy

from . import glb, images, lamps, presence, surface, world

TURN = numpy.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=float)
SHAPED = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
OWN, BAKED, KEPT = "own", "baked", "kept"  # what becomes of an item
KEPT_END = "~"  # last letter of the name of a node that gets no texels
SOURCE = "alpenglow_source"
# Modifiers with data of faces, edges or corners, which a cut of polygons would spoil.
BOUND = {"MULTIRES", "MESH_DEFORM", "SURFACE_DEFORM", "LAPLACIANDEFORM", "CORRECTIVE_SMOOTH",
         "MESH_SEQUENCE_CACHE", "EXPLODE", "CLOTH", "SOFT_BODY", "PARTICLE_SYSTEM"}


class ExportError(Exception):
    """Nothing can be baked. The message is for the user."""


@dataclass
class Item:
    """An object that the bake sees. Objects are found by name, since an undo changes addresses.
    key: names of instancer and object, and the number of the instance."""
    key: tuple
    name: str
    fate: str
    topology: int


def key_of(instance):
    parent = instance.parent.name_full if instance.is_instance else ""
    return (parent, instance.object.name_full, tuple(instance.persistent_id))


def shapes(depsgraph, selected_only):
    """Instances of the scene that have a surface. Each is valid until the next."""
    for instance in depsgraph.object_instances:
        shown = (instance.parent if instance.is_instance else instance.object).original
        if instance.object.type not in SHAPED or not instance.show_self or shown.hide_render:
            continue
        if instance.is_instance and instance.object.original.hide_render:
            continue
        if instance.object.type != instance.object.original.type:
            continue  # the drawn mesh of a curve, a text or a metaball, which comes by itself too
        if not selected_only or shown.select_get():
            yield instance


def topology_of(mesh):
    """A checksum of corners, polygons and materials."""
    corners = numpy.empty(len(mesh.loops), numpy.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    totals = numpy.empty(len(mesh.polygons), numpy.int32)
    mesh.polygons.foreach_get("loop_total", totals)
    slots = numpy.empty(len(mesh.polygons), numpy.int32)
    mesh.polygons.foreach_get("material_index", slots)
    return zlib.crc32(slots.tobytes(), zlib.crc32(totals.tobytes(), zlib.crc32(corners.tobytes())))


def material_of(shown, mesh, index):
    """The material of a slot of an evaluated object: the original, or None."""
    slots = shown.material_slots
    found = slots[index].material if index < len(slots) else None
    if found is None and index < len(mesh.materials):
        found = mesh.materials[index]
    return None if found is None else found.original


def bound_names(view_layer):
    """Objects whose own mesh may not be cut: modifiers are bound to it."""
    found = set()
    for shown in view_layer.objects:
        for modifier in shown.modifiers:
            if modifier.type in BOUND:
                found.add(shown.name_full)
            if modifier.type == "SURFACE_DEFORM" and modifier.target is not None:
                found.add(modifier.target.name_full)
    return found


def reason_to_keep(shown, view_layer):
    """Why a shown object takes no result, for the user; None for one that takes it."""
    if shown.library is not None or shown.override_library is not None:
        return "is linked from another file", "make it local to bake it"
    if shown.name_full not in view_layer.objects:
        return "is in a background scene", "bake that scene to bake it"
    return None


def fate_of(instance, mesh, cannot_take):
    """cannot_take: names of objects that do not take the result themselves."""
    shown = (instance.parent if instance.is_instance else instance.object).original
    if instance.is_instance or shown.name_full in cannot_take or shown.type != "MESH":
        return BAKED
    return OWN if topology_of(mesh) == topology_of(shown.data) else BAKED


def unread(name, shown):
    """Lines for the user: settings of an object that no bake reads."""
    if not shown.visible_shadow:
        yield f"{name}: Ray Visibility without Shadow is not read; the object shades others"
    if not shown.visible_diffuse:
        yield f"{name}: Ray Visibility without Diffuse is not read; the object reflects onto others"


def replaced_names(context):
    """Objects that an earlier bake made of objects that show again. The bake skips them."""
    view_layer = context.view_layer
    return {o.name_full for o in view_layer.objects
            if o.get(SOURCE) is not None and o[SOURCE].name in view_layer.objects
            and o[SOURCE].visible_get()}


class Exporter:
    def __init__(self, context, selected_only, with_lamps=True):
        self.context, self.selected_only, self.with_lamps = context, selected_only, with_lamps
        self.depsgraph = context.evaluated_depsgraph_get()
        self.writer, self.items, self.notes = glb.Writer(), [], []
        self.materials, self.textures, self.suns = {}, {}, []

    def write(self, path):
        replaced = replaced_names(self.context)
        self.add_shapes(replaced)
        if not any(item.fate != KEPT for item in self.items):
            raise ExportError("nothing to bake: " + ("; ".join(dict.fromkeys(self.notes)) or (
                "select objects with a surface, or bake what is visible" if self.selected_only
                else "no visible object of this file has a surface")))
        if self.with_lamps:
            self.add_lamps(replaced)
        self.add_camera(self.context.scene.camera)
        self.writer.write(path)
        self.notes = list(dict.fromkeys(self.notes))

    def add_lamps(self, replaced):
        for instance in self.depsgraph.object_instances:
            shown = instance.parent if instance.is_instance else instance.object
            if instance.object.type == "LIGHT" and instance.show_self and \
                    not shown.original.hide_render and shown.name_full not in replaced:
                self.add_lamp(instance.object, instance.matrix_world)

    def add_shapes(self, replaced):
        cannot_take = bound_names(self.context.view_layer) | {
            i.parent.name_full for i in self.depsgraph.object_instances if i.is_instance}
        for instance in shapes(self.depsgraph, self.selected_only):
            if instance.object.name_full in replaced and not instance.is_instance:
                continue
            mesh = instance.object.to_mesh()
            try:
                if mesh is not None and len(mesh.polygons):
                    self.add_shape(instance, mesh, fate_of(instance, mesh, cannot_take))
            finally:
                instance.object.to_mesh_clear()

    def add_shape(self, instance, mesh, fate):
        shown = instance.object.original
        key, name = key_of(instance), shown.name
        if instance.is_instance and key[0] != shown.name_full:
            name = f"{instance.parent.name}/{name}"
        if not presence.takes_part(mesh, instance.matrix_world, name, self.notes):
            return
        kept = reason_to_keep((instance.parent if instance.is_instance else instance.object)
                              .original, self.context.view_layer)
        if kept is not None:
            fate = KEPT
            self.notes.append(f"{name} {kept[0]}: it shades and reflects, and keeps its look; "
                              f"{kept[1]}")
        elif not presence.has_room(shown, mesh, name, self.notes):
            fate = KEPT
        self.notes += unread(name, instance.object)
        primitives = self.primitives_of(instance.object, mesh)
        element = {"name": name, "primitives": primitives}
        node = {"name": node_name(name, fate), "mesh": self.writer.add("meshes", element),
                "extras": {"item": len(self.items)}}
        self.add_node(node, instance.matrix_world)
        self.items.append(Item(key, name, fate, topology_of(mesh)))

    def add_node(self, node, matrix):
        """Places a node: glTF has Y up and columns first, Blender Z up."""
        placed = TURN @ numpy.array(matrix)
        node["matrix"] = placed.T.ravel().tolist()
        self.writer.document["scenes"][0]["nodes"].append(self.writer.add("nodes", node))

    def primitives_of(self, shown, mesh):
        loops = Loops(mesh)
        primitives = []
        for slot in numpy.unique(loops.slots).tolist():
            material = material_of(shown, mesh, slot)
            index, uv_maps = self.material_index(material)
            triangles = loops.triangles[loops.slots == slot]
            used, corners = numpy.unique(triangles, return_inverse=True)
            add = self.writer.add_accessor
            attributes = {"POSITION": add(loops.positions[used], "VEC3", bounds=True),
                          "NORMAL": add(loops.normals[used], "VEC3"),
                          "_LOOP": add(used.astype("<u4").view(numpy.uint8).reshape(-1, 4), "VEC4")}
            for number, name in enumerate(uv_maps if mesh.uv_layers else ()):
                attributes[f"TEXCOORD_{number}"] = add(uvs_of(mesh, name)[used], "VEC2")
            indices = add(corners.astype(numpy.uint32).ravel(), "SCALAR", glb.ELEMENT_ARRAY_BUFFER)
            primitives.append({"attributes": attributes, "indices": indices, "material": index})
        return primitives

    def material_index(self, material):
        """(index of the glTF material, names of the UV maps of its textures)."""
        key = None if material is None else material.name_full
        if key not in self.materials:
            read, notes = surface.read(material)
            self.notes += notes
            element, uv_maps = images.material_element(self, material, read)
            self.materials[key] = self.writer.add("materials", element), uv_maps
        return self.materials[key]

    def add_lamp(self, shown, matrix):
        lamp = shown.data
        if lamp.energy < 0:
            self.notes.append(f"{shown.name} takes light away, which no bake does: left out")
        if lamps.is_dark(shown):
            return
        self.notes += lamps.unread(shown)
        if lamp.type == "SUN":
            self.suns.append((lamp.energy, lamp.angle))
        if lamp.type == "AREA":
            self.add_area_lamp(shown, matrix)
            return
        self.writer.use("KHR_lights_punctual")
        extensions = self.writer.document.setdefault("extensions", {})
        lights = extensions.setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(lamps.punctual(lamp))
        reference = {"KHR_lights_punctual": {"light": len(lights) - 1}}
        self.add_node({"name": shown.name, "extensions": reference}, matrix)

    def add_area_lamp(self, shown, matrix):
        """An area lamp is a plate that emits from its front and blocks no light."""
        lamp = shown.data
        corners = lamps.outline_of(lamp)
        area = lamps.world_area(corners, matrix)
        if area <= 0:
            return
        fan = numpy.array([(0, i, i + 1) for i in range(1, len(corners) - 1)], numpy.uint32)
        add = self.writer.add_accessor
        normals = numpy.tile(numpy.float32((0, 0, -1)), (len(corners), 1))
        plate = lamps.plate(lamp, lamps.radiance_of(lamp.energy, area))
        element, _ = images.material_element(self, None, plate)
        element.update(name=lamp.name, doubleSided=False)
        primitive = {"attributes": {"POSITION": add(numpy.float32(corners), "VEC3", bounds=True),
                                    "NORMAL": add(normals, "VEC3")},
                     "indices": add(fan.ravel(), "SCALAR", glb.ELEMENT_ARRAY_BUFFER),
                     "material": self.writer.add("materials", element)}
        mesh = self.writer.add("meshes", {"name": shown.name, "primitives": [primitive]})
        self.add_node({"name": node_name(shown.name, KEPT), "mesh": mesh}, matrix)

    def add_camera(self, shown):
        if shown is None or shown.data.type != "PERSP":
            return
        camera, render = shown.data, self.context.scene.render
        width = render.resolution_x * render.pixel_aspect_x
        height = render.resolution_y * render.pixel_aspect_y
        frame = camera.view_frame(scene=self.context.scene)  # corners at the distance of the frame
        tangent = max(abs(c.y / c.z) for c in frame)
        perspective = {"yfov": 2 * float(numpy.arctan(tangent)), "aspectRatio": width / height,
                       "znear": camera.clip_start, "zfar": camera.clip_end}
        index = self.writer.add("cameras", {"type": "perspective", "perspective": perspective})
        placed = shown.matrix_world.normalized()
        self.add_node({"name": shown.name, "camera": index}, placed)

    def has_kept_nodes(self):
        nodes = self.writer.document["nodes"]
        return any(n["name"].endswith(KEPT_END) for n in nodes if "mesh" in n)

    def scene_options(self, folder):
        """Options of the command for suns and sky. An image of the sky is written into `folder`."""
        sky = world.sky_options(self.context.scene.world, folder, self.notes)
        return lamps.sun_options(self.suns) + sky


def node_name(name, fate):
    """Names that end in "~" are those that get no texels; another such name gets a space."""
    if fate == KEPT:
        return name + KEPT_END
    return name + " " if name.endswith(KEPT_END) else name


def uvs_of(mesh, name):
    """glTF's coordinates [loops][2] of a UV map, or of the one that renders."""
    layer = mesh.uv_layers.get(name) if name else None
    if layer is None:
        layer = next((u for u in mesh.uv_layers if u.active_render), mesh.uv_layers[0])
    uvs = numpy.empty(2 * len(mesh.loops), numpy.float32)
    layer.data.foreach_get("uv", uvs)
    uvs = uvs.reshape(-1, 2)
    uvs[:, 1] = 1 - uvs[:, 1]  # glTF counts from the first row of an image, Blender from the last
    return uvs


class Loops:
    """Arrays of a mesh: positions, normals [loops][3]; triangles [n][3] of loops; slots [n] of
    materials."""

    def __init__(self, mesh):
        if hasattr(mesh, "calc_normals_split"):  # until Blender 4.0
            mesh.calc_normals_split()
        mesh.calc_loop_triangles()
        count = len(mesh.loops)
        vertices = numpy.empty(3 * len(mesh.vertices), numpy.float32)
        mesh.vertices.foreach_get("co", vertices)
        corners = numpy.empty(count, numpy.int32)
        mesh.loops.foreach_get("vertex_index", corners)
        self.positions = vertices.reshape(-1, 3)[corners]
        normals = numpy.empty(3 * count, numpy.float32)
        if hasattr(mesh, "corner_normals"):  # from Blender 4.1
            mesh.corner_normals.foreach_get("vector", normals)
        else:
            mesh.loops.foreach_get("normal", normals)
        self.normals = normals.reshape(-1, 3)
        self.mend_normals(mesh)
        triangles = numpy.empty(3 * len(mesh.loop_triangles), numpy.int32)
        mesh.loop_triangles.foreach_get("loops", triangles)
        self.triangles = triangles.reshape(-1, 3)
        self.slots = numpy.empty(len(mesh.loop_triangles), numpy.int32)
        mesh.loop_triangles.foreach_get("material_index", self.slots)

    def mend_normals(self, mesh):
        """Gives corners without a normal that of their polygon, or +Z for one without area."""
        lengths = numpy.linalg.norm(self.normals, axis=1)
        wrong = numpy.flatnonzero(~(lengths > 0.5))  # also NaN
        if len(wrong) == 0:
            return
        normals = numpy.empty(3 * len(mesh.polygons), numpy.float32)
        mesh.polygons.foreach_get("normal", normals)
        totals = numpy.empty(len(mesh.polygons), numpy.int32)
        mesh.polygons.foreach_get("loop_total", totals)
        polygons = numpy.repeat(numpy.arange(len(totals)), totals)  # corners lie in their order
        normals = normals.reshape(-1, 3)[polygons[wrong]]
        normals[~(numpy.linalg.norm(normals, axis=1) > 0.5)] = (0, 0, 1)
        self.normals[wrong] = normals
