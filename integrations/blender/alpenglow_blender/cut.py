# SPDX-License-Identifier: MIT
"""Cuts polygons that lie in two charts of the atlas into the triangles that Blender draws.

A loop of a mesh has one coordinate in a UV map. A chart border along a diagonal needs two. The cut
adds the diagonals as edges. The surface, its normals and all other layers stay."""

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
    owners = numpy.unique(polygons[triangles]).tolist()
    normals = export.Loops(mesh).normals if mesh.has_custom_normals else None
    work = bmesh.new()
    work.from_mesh(mesh)
    try:
        old_loop = number_loops(work)
        work.faces.ensure_lookup_table()
        for face, owner in [(work.faces[i], i) for i in owners]:
            parts = numpy.flatnonzero(polygons == owner)
            cut_polygon(work.loops.layers.uv[uv_map], face, corners[parts] - starts[owner],
                        places[parts])
        old = numpy.array([loop[old_loop] for face in work.faces for loop in face.loops])
        work.loops.layers.int.remove(old_loop)
        work.to_mesh(mesh)
    finally:
        work.free()
    if normals is not None:
        mesh.normals_split_custom_set(normals[old])
    mesh.update()
    return len(owners)


def number_loops(work):
    """A layer that keeps the number of each loop over the cut."""
    layer = work.loops.layers.int.new("alpenglow_loop")
    number = 0
    for face in work.faces:
        for loop in face.loops:
            loop[layer] = number
            number += 1
    return layer


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
