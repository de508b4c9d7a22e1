#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""textured_room.py OUT.glb: a corner of a room whose walls carry a picture, for comparing with
other renderers under a sky: all of it is lit alike, so that little noise is left.

Its second UV set fills whole texels of a page of 128 x 128, so that nobody's rule for cut texels
matters; nothing touches or stands inside anything else, for the same reason; materials are
double-sided, as renderers that know no other take them. The picture is of wide stripes, for whether
it is interpolated before or after its decoding then matters in 1 part of 64 only, and it differs
from all its mirrored and turned forms. It has a third UV set: Blender reads a picture of the first
set through whichever set is current. 13 quads: three walls, six sides of a block, two a shelf, two
a lamp (one quad each way up), each in a cell of 32 texels.
"""
import json
import struct
import sys
import zlib

CELL, MARGIN, PAGE = 32, 2, 128


def png(width, height, pixel):
    rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(width))
                    for y in range(height))

    def chunk(kind, data):
        checksum = struct.pack(">I", zlib.crc32(kind + data))
        return struct.pack(">I", len(data)) + kind + data + checksum

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) +
            chunk(b"IEND", b""))


def stripes(x, y):
    """Three wide stripes across, and a dark corner on the upper left."""
    if x < 96 and y < 96:
        return (60, 40, 110)
    return ((230, 120, 60), (240, 235, 220), (70, 190, 110))[min(y // 86, 2)]


def box(low, high, inwards):
    """Six quads (corner, u, v), u x v pointing to the side that is seen."""
    quads = []
    for axis in range(3):
        for side in (0, 1):
            corner, u, v = list(low), [0, 0, 0], [0, 0, 0]
            corner[axis] = high[axis] if side else low[axis]
            second, third = (axis + 1) % 3, (axis + 2) % 3
            u[second], v[third] = high[second] - low[second], high[third] - low[third]
            quads.append((corner, u, v) if bool(side) != inwards else (corner, v, u))
    return quads


def main():
    walls = box((0, 0, 0), (4, 3, 5), True)[::2]  # floor, left and back
    block = box((1.0, 0.4, 2.6), (2.2, 1.6, 3.6), False)
    lamp = [((1, 2.1, 0.5), (2, 0, 0), (0, 0, 2)), ((1, 2.11, 0.5), (0, 0, 2), (2, 0, 0))]
    shelf = [((2.6, 1.0, 0.6), (0, 0, 1.5), (1, 0, 0)), ((2.6, 0.95, 0.6), (1, 0, 0), (0, 0, 1.5))]
    picture = {"baseColorTexture": {"index": 0, "texCoord": 2},
               "baseColorFactor": [0.9, 0.8, 1, 1], "metallicFactor": 0}
    materials = [
        {"name": "picture", "doubleSided": True, "pbrMetallicRoughness": picture},
        {"name": "block", "doubleSided": True,
         "pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.6, 0.3, 1], "metallicFactor": 0}},
        {"name": "lamp", "doubleSided": True, "emissiveFactor": [1, 0.8, 0.6],
         "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 1}},
         "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}},
    ]
    binary, views, accessors, meshes, cell = b"", [], [], [], 0

    def view(data):
        nonlocal binary
        binary += b"\0" * (-len(binary) % 4)
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary += data
        return len(views) - 1

    def accessor(rows, kind, component=5126, code="f"):
        flat = [value for row in rows for value in row]
        entry = {"bufferView": view(struct.pack("<%d%s" % (len(flat), code), *flat)),
                 "componentType": component, "type": kind,
                 "count": len(flat) // {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[kind]}
        if kind == "VEC3":
            entry["min"], entry["max"] = ([f(axis) for axis in zip(*rows)] for f in (min, max))
        accessors.append(entry)
        return len(accessors) - 1

    for name, quads, material in (("walls", walls, 0), ("block", block, 1), ("shelf", shelf, 0),
                                  ("lamp", lamp, 2)):
        positions, normals, uvs, light_uvs, indices = [], [], [], [], []
        for corner, u, v in quads:
            normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                      u[0] * v[1] - u[1] * v[0]]
            length = sum(x * x for x in normal) ** 0.5
            first = len(positions)
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                positions.append([corner[k] + a * u[k] + b * v[k] for k in range(3)])
                normals.append([x / length for x in normal])
                uvs.append([a, b])
                light_uvs.append([(cell % 4 * CELL + MARGIN + a * (CELL - 2 * MARGIN)) / PAGE,
                                  (cell // 4 * CELL + MARGIN + b * (CELL - 2 * MARGIN)) / PAGE])
            indices += [[first + k] for k in (0, 1, 2, 0, 2, 3)]
            cell += 1
        light = accessor(light_uvs, "VEC2")
        attributes = {"POSITION": accessor(positions, "VEC3"), "NORMAL": accessor(normals, "VEC3"),
                      "TEXCOORD_0": light, "TEXCOORD_1": light, "TEXCOORD_2": accessor(uvs, "VEC2")}
        primitive = {"attributes": attributes, "material": material,
                     "indices": accessor(indices, "SCALAR", 5123, "H")}
        meshes.append({"name": name, "primitives": [primitive]})
    image = view(png(256, 256, stripes))
    document = {
        "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_emissive_strength"],
        "scene": 0,
        "scenes": [{"nodes": list(range(len(meshes)))}],
        "nodes": [{"mesh": i, "name": mesh["name"]} for i, mesh in enumerate(meshes)],
        "meshes": meshes, "materials": materials, "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"magFilter": 9729, "minFilter": 9729, "wrapS": 10497, "wrapT": 10497}],
        "images": [{"bufferView": image, "mimeType": "image/png"}],
        "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(binary) + -len(binary) % 4}]}
    binary += b"\0" * (-len(binary) % 4)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(sys.argv[1], "wb") as out:
        out.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(binary)))
        out.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        out.write(struct.pack("<II", len(binary), 0x004E4942) + binary)


main()
