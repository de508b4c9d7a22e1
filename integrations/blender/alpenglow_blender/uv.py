# SPDX-License-Identifier: MIT
"""The UV map of a bake. A property of the mesh names it, since the user may have one of that name.

A mesh without UV maps whose materials read one gets an empty map first. Without it, textures would
read the map of the bake, as the only one. With it they read the place (0, 0), as before."""

import numpy

from . import nodes

OURS, FIRST = "alpenglow_uv_map", "alpenglow_first_uv_map"  # properties of a mesh
FIRST_NAME = "UVMap"
READERS = {"TEX_IMAGE", "TEX_COORD", "UVMAP", "NORMAL_MAP", "TANGENT"}


def ours(mesh):
    """The layer of an earlier bake, or None."""
    name = mesh.get(OURS)
    return mesh.uv_layers.get(name) if name is not None else None


def reads_uv(tree):
    """Whether nodes of a tree, or of a group in it, may read the active UV map."""
    waiting, seen = [tree], set()
    while waiting:
        tree = waiting.pop()
        if tree is None or tree in seen:
            continue
        seen.add(tree)
        for node in tree.nodes:
            if node.type in READERS and not node.get(nodes.MARK):
                return True
            if node.type == "GROUP":
                waiting.append(node.node_tree)
    return False


def needs_first(mesh, materials):
    return not mesh.uv_layers and any(m is not None and m.use_nodes and reads_uv(m.node_tree)
                                      for m in materials)


def has_room(mesh, materials, name, notes):
    """Whether the mesh can take the map of a bake: Blender holds eight. A note says why not."""
    if ours(mesh) is not None or len(mesh.uv_layers) + needs_first(mesh, materials) < 8:
        return True
    notes.append(f"{name} has eight UV maps: it shades and reflects, and gets no map; "
                 "remove one and bake again")
    return False


def add(mesh, materials, loops, places):
    """Adds the UV map of a bake, or fills that of an earlier one. Returns its name.
    loops [triangles][3]; places [triangles][3][2]."""
    if needs_first(mesh, materials):
        first = mesh.uv_layers.new(name=FIRST_NAME, do_init=False)
        first.data.foreach_set("uv", numpy.zeros(2 * len(mesh.loops), numpy.float32))
        mesh[FIRST] = first.name
    layer = ours(mesh) or mesh.uv_layers.new(name=nodes.UV_MAP, do_init=False)
    mesh[OURS] = layer.name
    uvs = numpy.zeros((len(mesh.loops), 2), numpy.float32)  # polygons without area have no triangle
    uvs[loops] = places
    layer.data.foreach_set("uv", uvs.ravel())
    mesh.update()
    return mesh[OURS]


def remove(mesh):
    """Removes the maps that bakes added. Returns whether there was one."""
    found = False
    for key in (OURS, FIRST):
        if key not in mesh:
            continue
        layer = mesh.uv_layers.get(mesh[key])
        del mesh[key]
        if layer is not None:
            mesh.uv_layers.remove(layer)
            found = True
    return found
