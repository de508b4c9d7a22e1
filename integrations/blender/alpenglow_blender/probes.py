# SPDX-License-Identifier: MIT
"""Probes: NAME.probes.json beside the .blend, and an object that shows where they stand."""

import json
import os

import bpy

NAME = "Alpenglow probes"
FORMAT = "alpenglow-probes"


class ProbesError(OSError):
    """There is no place for probes. The message is for the user."""


def place(context):
    """The path of the probes of this file."""
    if not bpy.data.filepath:
        raise ProbesError("save the .blend first: probes are written beside it")
    path = os.path.splitext(bpy.data.filepath)[0] + ".probes.json"
    check_ours(path)
    return path


def check_ours(path):
    """Raises ProbesError if files that a bake would overwrite are not probes of Alpenglow."""
    textures = [path.removesuffix("json") + end for end in ("ktx2", "moments.ktx2")]
    found = next((p for p in [path] + textures if os.path.lexists(p)), None)
    if found is not None and not is_probes(path):
        raise ProbesError(f"{found}: is not from a bake of probes, which would overwrite it; move "
                          "or rename it")


def is_probes(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file).get("format") == FORMAT
    except (OSError, ValueError, AttributeError):
        return False


def options(settings):
    """Options of the command."""
    spacing = "auto" if settings.spacing <= 0 else f"{settings.spacing:.6g}"
    return ["--spacing", spacing]


def positions(description):
    """Places (x, y, z) of the probes in Blender's axes, Z up, metres."""
    if description["layout"] == "list":
        found = description["positions"]
    else:
        (nx, ny, nz), origin = description["size"], description["origin"]
        step = description["spacing"]
        found = [(origin[0] + x * step[0], origin[1] + y * step[1], origin[2] + z * step[2])
                 for z in range(nz) for y in range(ny) for x in range(nx)]
    return [(x, -z, y) for x, y, z in found]


def show(context, path):
    """Shows baked probes as loose vertices, which no render shows. Returns their number."""
    with open(path, encoding="utf-8") as file:
        description = json.load(file)
    shown = bpy.data.objects.get(NAME)
    mesh = bpy.data.meshes.new(NAME)
    mesh.from_pydata(positions(description), [], [])
    if shown is None or shown.type != "MESH" or shown.library is not None:
        shown = bpy.data.objects.new(NAME, mesh)
        context.scene.collection.objects.link(shown)
    else:
        old, shown.data = shown.data, mesh
        if old.users == 0:
            bpy.data.meshes.remove(old)
    shown["file"] = bpy.path.relpath(path) if bpy.data.filepath else path
    for key in ("layout", "basis", "quantity", "units", "size", "origin", "spacing"):
        if key in description:
            shown[key] = description[key]
    return description["count"]
