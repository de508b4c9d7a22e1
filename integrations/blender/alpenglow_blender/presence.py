# SPDX-License-Identifier: MIT
"""Whether an object can take part in a bake, and whether it can take the map.

The command leaves out triangles without area, and those with a coordinate that is not finite or
beyond 1e15 m. An object of such triangles alone gets no texels."""

import numpy

from . import uv

FARTHEST = 1e15  # metres from the origin
NOT_FINITE = "has a coordinate that is not a finite number: it is left out of the bake; delete " \
             "that vertex, or check the modifiers and the transform"
TOO_FAR = "is more than 1e15 m away: it is left out of the bake; move it nearer to the origin"
NO_AREA = "has no area: it is left out of the bake; check its scale and its faces"


def fault_of(mesh, matrix):
    """Why a mesh with polygons takes no part, or "". matrix: 4 x 4, to the world."""
    vertices = numpy.empty(3 * len(mesh.vertices), numpy.float32)
    mesh.vertices.foreach_get("co", vertices)
    placed = numpy.array(matrix, float)
    with numpy.errstate(over="ignore", invalid="ignore"):
        world = vertices.reshape(-1, 3) @ placed[:3, :3].T + placed[:3, 3]
        corners = numpy.float32(world)[triangles_of(mesh)].astype(float)
        if not numpy.isfinite(vertices).all() or not numpy.isfinite(world).all():
            return NOT_FINITE
        near = corners[(numpy.abs(corners) <= FARTHEST).all(axis=(1, 2))]
        sides = near[:, 1:] - near[:, :1]
        areas = numpy.linalg.norm(numpy.cross(sides[:, 0], sides[:, 1]), axis=1)
    if not len(near):
        return TOO_FAR
    return "" if (areas > 0).any() else NO_AREA


def triangles_of(mesh):
    """Vertices [triangles][3] of the triangles that Blender draws."""
    mesh.calc_loop_triangles()
    triangles = numpy.empty(3 * len(mesh.loop_triangles), numpy.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    return triangles.reshape(-1, 3)


def takes_part(mesh, matrix, name, notes):
    """Whether a mesh with polygons takes part in a bake. A note says why not."""
    fault = fault_of(mesh, matrix)
    if fault:
        notes.append(f"{name} {fault}")
    return not fault


def has_room(shown, mesh, name, notes):
    """Whether an evaluated mesh of the original `shown` can take the map. A note says why not."""
    holder = shown.data if shown.type == "MESH" else mesh
    return uv.has_room(holder, [slot.material for slot in shown.material_slots], name, notes)
