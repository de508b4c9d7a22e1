# SPDX-License-Identifier: MIT
"""Cuts polygons that lie in two charts of the atlas into the triangles that Blender draws.

A loop of a mesh has one coordinate in a UV map. A chart border along a diagonal needs two. The cut
adds the diagonals as edges. The normals of all corners become custom normals, since Blender would
compute others from the new polygons. The surface and all other layers stay."""

import math

import bmesh
import numpy

from . import export


def divided(uvs, corners, places):
    """Triangles [n] of polygons that lie in two charts: those with a corner whose loop has another
    place. uvs [loops][2]; corners [triangles][3] loops; places [triangles][3][2]."""
    return numpy.flatnonzero((uvs[corners] != places).any(axis=(1, 2)))


def cut(mesh, uv_map, corners, places):
    """Cuts the polygons of a mesh that `uv_map` cannot hold, and returns their number."""
    uvs = numpy.empty(2 * len(mesh.loops), numpy.float32)
    mesh.uv_layers[uv_map].data.foreach_get("uv", uvs)
    triangles = divided(uvs.reshape(-1, 2), corners, places)
    if not len(triangles):
        return 0
    starts = numpy.empty(len(mesh.polygons), numpy.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    polygons = numpy.searchsorted(starts, corners[:, 0], side="right") - 1
    owners = numpy.unique(polygons[triangles])
    parts = parts_of(polygons, owners)
    normals = export.Loops(mesh).normals
    numbers = number_loops(mesh)
    work = bmesh.new()
    try:
        work.from_mesh(mesh)
        work.faces.ensure_lookup_table()
        layer = work.loops.layers.uv[uv_map]
        for face, owner, part in [(work.faces[i], i, p) for i, p in zip(owners.tolist(), parts)]:
            cut_polygon(layer, face, corners[part] - starts[owner], places[part])
        work.to_mesh(mesh)
    finally:
        work.free()
    set_normals(mesh, normals[take_numbers(mesh, numbers)])
    return len(owners)


def parts_of(polygons, owners):
    """Triangles [owners][n] of each owner. polygons [triangles] is the polygon of each."""
    triangles = numpy.flatnonzero(numpy.isin(polygons, owners))
    triangles = triangles[numpy.argsort(polygons[triangles], kind="stable")]
    return numpy.split(triangles, numpy.searchsorted(polygons[triangles], owners[1:]))


def number_loops(mesh):
    """Adds an attribute that keeps the number of each loop over the cut. Returns its name."""
    attribute = mesh.attributes.new("alpenglow_loop", "INT", "CORNER")
    attribute.data.foreach_set("value", numpy.arange(len(mesh.loops), dtype=numpy.int32))
    return attribute.name


def take_numbers(mesh, name):
    """The numbers [loops] before the cut. Removes the attribute."""
    numbers = numpy.empty(len(mesh.loops), numpy.int32)
    mesh.attributes[name].data.foreach_get("value", numbers)
    mesh.attributes.remove(mesh.attributes[name])
    return numbers


def set_normals(mesh, normals):
    """Makes normals [loops][3] the custom normals of a mesh. Blender keeps two 16-bit angles."""
    if hasattr(mesh, "use_auto_smooth") and not mesh.use_auto_smooth:  # until Blender 4.0
        mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.pi
    mesh.normals_split_custom_set(normals)
    mesh.update()


def cut_polygon(layer, face, corners, places):
    """Cuts a face into its triangles. corners [n][3] count the corners of the face from 0;
    places [n][3][2] are their coordinates."""
    vertices = [loop.vert for loop in face.loops]
    triangles = {}
    for three, uvs in zip(corners.tolist(), places.tolist()):
        triangles[frozenset(vertices[i] for i in three)] = \
            {vertices[i]: uv for i, uv in zip(three, uvs)}
    for part in cut_face(face, triangles):
        uvs = triangles.get(frozenset(part.verts), {})
        for loop in part.loops:
            if loop.vert in uvs:
                loop[layer].uv = uvs[loop.vert]


def cut_face(face, triangles):
    """The parts of a face: triangles, if each of its triangles can be cut off along edges."""
    waiting, done = [face], []
    while waiting:
        part = waiting.pop()
        diagonal = find_diagonal(part, triangles)
        if diagonal is None:
            done.append(part)
            continue
        other, loop = bmesh.utils.face_split(part, *diagonal)
        loop.edge.smooth = True
        waiting += [part, other]
    return done


def find_diagonal(part, triangles):
    """Two vertices of a part that a triangle connects and no edge of the part does; or None."""
    ring = list(part.verts)
    neighbours = {frozenset((ring[i - 1], ring[i])) for i in range(len(ring))}
    for triangle in triangles:
        if len(ring) == 3 or not triangle <= set(ring):
            continue
        for left_out in triangle:
            side = triangle - {left_out}
            if side not in neighbours:
                return tuple(side)
    return None
